// Scene files; private to framework/scene. The format is described in samples/scenes/README.md.
#pragma once

#include <filesystem>

#include "fovea/error.h"
#include "framework/base/json.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// Throws Error(BadInput) with every mistake of the file and its place; then what loading its models throws.
Scene loadSceneFile(const std::filesystem::path& file, Diagnostics& warnings);
Scene parseSceneFile(const json::Value& root, const std::filesystem::path& file, Diagnostics& warnings);

// Appends `model` under a new root node with this transform; its lights and cameras move along.
struct Placement {
  std::string name;
  glm::vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1};
  bool lights = true;
};
void appendModel(Scene& scene, Scene&& model, const Placement& placement);

// For models that bring neither: a view of the whole model from its front, and a sun.
void addDefaultCamera(Scene& scene, const Geometry& geometry);
void addDefaultLight(Scene& scene);

// An orientation that looks along `direction`.
glm::quat lookAlong(glm::vec3 direction, glm::vec3 up);

}  // namespace fovea::scene
