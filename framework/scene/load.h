// Where scenes are looked for, and loading a model alone.
#pragma once

#include <filesystem>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Folders to look in for models that a scene file names: $FOVEA_SCENES (colon-separated), then ../shared/scenes beside the
// source or working folder. Scene files by bare name: samples/scenes of the source or the installation.
std::vector<std::filesystem::path> modelSearchPath();
std::vector<std::filesystem::path> sceneSearchPath();

// The model alone, without a default view or light. Guards against everything that a hostile file can do; gltf/check.h
// says what that is.
Scene loadGltf(const std::filesystem::path& file, Diagnostics& warnings);

}  // namespace fovea::scene
