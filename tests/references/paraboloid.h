// Paraboloid maps, as a plain reference for shaders/vpls/paraboloid.glsl, which explains the mapping.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shaders/records/paraboloid.h"

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

// Projects a local vector of length `len` > 0 with z > -len to the plane of the map; |p| <= 1 for the hemisphere.
inline glm::vec2 paraboloidProject(glm::vec3 local, float len) { return glm::vec2(local) / (len + local.z); }

// Converts a point of the map's plane to the local unit direction.
inline glm::vec3 paraboloidDirection(glm::vec2 p) {
  float q = glm::dot(p, p);
  return glm::vec3(2.0f * p, 1.0f - q) / (1.0f + q);
}

inline glm::vec2 paraboloidUv(glm::vec2 p) { return 0.5f * p + 0.5f; }
inline glm::vec2 paraboloidTexelCentre(glm::ivec2 texel, int size) {
  return (2.0f * glm::vec2(texel) + 1.0f) / float(size) - 1.0f;
}
inline glm::ivec2 paraboloidTexel(glm::vec2 p, int size) {
  return glm::clamp(glm::ivec2(glm::floor(paraboloidUv(p) * float(size))), glm::ivec2(0),
                    glm::ivec2(size - 1));
}
// Local unit direction through the centre of a texel; a texel with z <= 0 is unused.
inline glm::vec3 paraboloidTexelDirection(glm::ivec2 texel, int size) {
  return paraboloidDirection(paraboloidTexelCentre(texel, size));
}

inline AtlasLayout atlasLayout(int width, int height) {
  int shift = 0;
  while ((height << (shift + 1)) <= width) ++shift;
  return {height, shift};
}
inline glm::ivec3 atlasTexel(uint32_t slot, glm::ivec2 texel, AtlasLayout layout) {
  int map = int(slot) & ((1 << layout.shift) - 1);
  return {texel.x + map * layout.size, texel.y, int(slot) >> layout.shift};
}

}  // namespace fovea::scene
