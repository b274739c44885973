// What tests of passes with VPLs begin with.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "framework/scene/scene.h"
#include "framework/shader_twins/vpl.h"

namespace fovea::test {

// What a texel of a shadow map that sees nothing holds.
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A camera and a white material, nothing to see.
inline scene::Scene emptyScene() {
  scene::Scene s;
  s.name = "test";
  s.materials.emplace_back();
  s.cameras.emplace_back();
  return s;
}

// Of 1 W/sr.
inline scene::Vpl vpl(glm::vec3 position, glm::vec3 normal) {
  scene::Vpl v;
  v.position = position;
  v.normal = glm::normalize(normal);
  v.intensity = glm::vec3(1);
  return v;
}

}  // namespace fovea::test
