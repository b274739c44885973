// Search paths for scenes, and loading of a model on its own.
#pragma once

#include <filesystem>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Folders that are searched for the models that a scene file names: $FOVEA_SCENES (colon-separated), then
// ../shared/scenes beside the source folder or the working folder.
std::vector<std::filesystem::path> modelSearchPath();
// Folders that are searched for scene files given by bare name: samples/scenes of the source or the installation, and
// the folders in it.
std::vector<std::filesystem::path> sceneSearchPath();

// Loads a glTF model on its own, without a default view or light. Guards against hostile files; gltf/check.h
// gives the rules. fullMaterials: that of the scene; what only diffuse materials lack then needs no warning.
Scene loadGltf(const std::filesystem::path& file, Diagnostics& warnings, bool fullMaterials = false);

// Gives a scene whose nodes draw more than a million triangles coarser Primitive::lightIndices, each mesh once for all
// of its nodes. Returns whether it did.
bool addLightLevels(Scene& scene);

}  // namespace fovea::scene
