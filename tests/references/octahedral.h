// Octahedral unit vectors, as a plain reference for shaders/scene/octahedral.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace fovea::scene {

inline glm::vec3 octDecode(glm::vec2 e) {
  glm::vec3 n(e, 1 - std::abs(e.x) - std::abs(e.y));
  const float t = std::max(-n.z, 0.0f);
  n.x += n.x >= 0 ? -t : t;
  n.y += n.y >= 0 ? -t : t;
  return glm::normalize(n);
}

}  // namespace fovea::scene
