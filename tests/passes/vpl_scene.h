// Shared by the tests of passes with VPLs: shadow map values, an empty scene, and VPLs.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"

namespace fovea::test {

// Value of a shadow map's texel that sees nothing.
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A scene with a camera and a white material and nothing to see.
inline scene::Scene emptyScene() {
  scene::Scene s;
  s.name = "test";
  s.materials.emplace_back();
  s.cameras.emplace_back();
  return s;
}

// A VPL of 1 W/sr.
inline scene::Vpl vpl(glm::vec3 position, glm::vec3 normal) {
  scene::Vpl v;
  v.position = position;
  v.normal = glm::normalize(normal);
  v.intensity = glm::vec3(1);
  return v;
}

}  // namespace fovea::test
