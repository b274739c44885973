// A scene as a glTF 2.0 model, for other programs and for reading back.
#pragma once

#include <filesystem>
#include <string>

#include "fovea/error.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Writes into `folder` (made where it is missing):
//   NAME.gltf, NAME.bin, textures/*.png  the model: meshes, materials, nodes, lights (KHR_lights_punctual),
//                                        cameras, skins, morph targets, animations
//   NAME.json                            a scene file that names it and holds what glTF has no place for:
//                                        exposure, environment, gaze, distance of the eyes, camera path,
//                                        movers, moving lights, which animation plays
// NAME is the scene's name as safeFileName() has it. load() of the scene file gives back the same picture at
// any time; names of nodes, lights and animations that occur twice get a number. Control cages become the
// triangles that are seen, with their morph targets; one that follows joints stays at rest, with a warning.
// Returns the path of NAME.json. Throws Error(CannotWrite).
std::filesystem::path exportGltf(const Scene& scene, const std::filesystem::path& folder,
                                 Diagnostics& warnings);

}  // namespace fovea::scene
