// Directions around a surface. Local ones have the surface's normal as z.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace fovea::path_trace {

// From local to world directions: the columns are x, y and z, right-handed. normal: unit.
inline glm::mat3 frameAround(glm::vec3 normal) {
  const glm::vec3 aside = std::abs(normal.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 x = glm::normalize(glm::cross(aside, normal));
  return {x, glm::cross(normal, x), normal};
}

inline glm::vec3 toWorld(const glm::mat3& frame, glm::vec3 local) { return frame * local; }
inline glm::vec3 toLocal(const glm::mat3& frame, glm::vec3 world) { return glm::transpose(frame) * world; }

}  // namespace fovea::path_trace
