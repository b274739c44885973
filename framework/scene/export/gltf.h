// Exports a scene as a glTF 2.0 model, for other programs and for loading it again.
#pragma once

#include <filesystem>
#include <string>

#include "fovea/error.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// NAME is the name of the scene as safeFileName() returns it; an environment that lights it is in NAME_environment.exr.
// load() of the scene file gives the same picture at any time. Names of nodes, lights and animations that occur twice
// get a number. Control cages become the triangles that are visible, with their morph targets; a cage that follows
// joints stays at rest, with a warning. Returns the path of NAME.json. Throws Error(CannotWrite).
std::filesystem::path exportGltf(const Scene& scene, const std::filesystem::path& folder,
                                 Diagnostics& warnings);

}  // namespace fovea::scene
