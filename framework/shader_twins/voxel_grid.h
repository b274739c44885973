// The C++ version of shaders/voxels/voxel.glsl: both must be changed together. It places the voxel grid in which
// secondary lights are found.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "shaders/records/voxel.h"

namespace fovea::scene {

inline VoxelGrid voxelGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, int resolution) {
  const glm::vec3 extent = glm::max(boundsMax - boundsMin, glm::vec3(0.0f));
  const float longest = std::max(std::max(extent.x, extent.y), std::max(extent.z, 1e-3f));
  const float pad = 1e-3f * longest;
  return {boundsMin - pad, (longest + 2.0f * pad) / float(resolution), resolution};
}

// Side of a voxel, 0 or 1, to which a surface with this geometric normal belongs; shaders/voxels/voxel.glsl says how
// it is chosen.
inline uint32_t voxelSideOf(glm::vec3 normal) {
  const glm::vec3 a = glm::abs(normal);
  const float dominant = a.x >= a.y && a.x >= a.z ? normal.x : a.y >= a.z ? normal.y : normal.z;
  return dominant < 0.0f ? 1u : 0u;
}

}  // namespace fovea::scene
