// A round floor for scenes that have none.
#pragma once

#include <glm/glm.hpp>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct Floor {
  glm::vec3 position{0};  // its centre, m
  float radius = 1;       // m
  glm::vec3 color{0.5f};  // reflectance
};

// Appends it as a node, which is visible only from above.
void addFloor(Scene& scene, const Floor& floor);
// Undoes addFloor(), if nothing has been appended since.
void removeFloor(Scene& scene);

}  // namespace fovea::scene
