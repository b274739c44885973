// Directions in the frame of a normal.
#pragma once

#include <glm/glm.hpp>

namespace fovea::scene {

// Columns: tangent, bitangent, normal (unit, right-handed).
inline glm::mat3 orthonormalFrame(glm::vec3 n) {
  float s = n.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (s + n.z);
  float b = n.x * n.y * a;
  return {glm::vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x), glm::vec3(b, s + n.y * n.y * a, -n.y), n};
}

inline glm::vec3 toLocal(const glm::mat3& frame, glm::vec3 v) { return v * frame; }
inline glm::vec3 toWorld(const glm::mat3& frame, glm::vec3 v) { return frame * v; }

}  // namespace fovea::scene
