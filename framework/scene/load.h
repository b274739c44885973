// Loading: glTF models, scene files (JSON) and built-in scenes, all to scene::Scene.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "framework/base/diagnostic.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Folders to look in for models that a scene file names: $FOVEA_SCENES (colon-separated), then ../shared/scenes beside the
// source or working folder. Scene files by bare name: samples/scenes of the source or the installation.
std::vector<std::filesystem::path> modelSearchPath();
std::vector<std::filesystem::path> sceneSearchPath();

// nameOrFile: a built-in scene's or scene file's bare name ("cornellbox", "sponza"), or a .json, .gltf or .glb file. A bare
// model without light or camera gets a default view and a sun, with a warning.
// Throws Error(BadInput) with file, place and remedy; for a missing model also where to get it.
Scene load(const std::string& nameOrFile, Diagnostics& warnings);

// Only the model. Guards against everything a hostile file can do (see PLATFORM facts in gltf.cpp).
Scene loadGltf(const std::filesystem::path& file, Diagnostics& warnings);

// Built-in generators by name, e.g. "cornellbox"; deterministic.
std::vector<std::string> builtinNames();
Scene builtin(const std::string& name);

}  // namespace fovea::scene
