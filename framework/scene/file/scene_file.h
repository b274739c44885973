// Reads scene files, whose format samples/scenes/README.md describes. Private to framework/scene.
#pragma once

#include <filesystem>

#include "fovea/error.h"
#include "framework/base/json.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Throws Error(BadInput) with every mistake in the file and its place, then whatever loading the models throws.
Scene loadSceneFile(const std::filesystem::path& file, Diagnostics& warnings);
Scene parseSceneFile(const json::Value& root, const std::filesystem::path& file, Diagnostics& warnings);

// Appends `model` under a new root node with this transform, which also applies to its lights and cameras. The
// translation is in the author's coordinates.
struct Placement {
  std::string name;
  glm::dvec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  bool lights = true;
};
void appendModel(Scene& scene, Scene&& model, const Placement& placement);

// An orientation that looks along `direction`.
glm::quat lookAlong(glm::vec3 direction, glm::vec3 up);

}  // namespace fovea::scene
