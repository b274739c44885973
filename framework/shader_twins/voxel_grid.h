// The C++ version of shaders/common/voxel.glsl: both must be changed together. It defines the voxel grid in which
// VPLs are found and the records of the bundle "voxels".
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace fovea::scene {

// Cubic cells, `resolution` of them along the longest axis of the scene's bounds; the volume is a cube of cells.
struct VoxelGrid {
  glm::vec3 origin{0};  // world space, corner of cell (0, 0, 0)
  float cell = 1;       // edge, m
  int resolution = 1;

  glm::vec3 worldToVoxel(glm::vec3 position) const { return (position - origin) / cell; }
  glm::vec3 voxelToWorld(glm::vec3 voxel) const { return origin + voxel * cell; }
};

inline VoxelGrid voxelGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, int resolution) {
  const glm::vec3 extent = glm::max(boundsMax - boundsMin, glm::vec3(0.0f));
  const float longest = std::max(std::max(extent.x, extent.y), std::max(extent.z, 1e-3f));
  const float pad = 1e-3f * longest;
  return {boundsMin - pad, (longest + 2.0f * pad) / float(resolution), resolution};
}

// Side of a voxel, 0 or 1, to which a surface with this geometric normal belongs; shaders/common/voxel.glsl says how
// it is chosen.
inline uint32_t voxelSideOf(glm::vec3 normal) {
  const glm::vec3 a = glm::abs(normal);
  const float dominant = a.x >= a.y && a.x >= a.z ? normal.x : a.y >= a.z ? normal.y : normal.z;
  return dominant < 0.0f ? 1u : 0u;
}

// Records of the bundle "voxels", which shaders/common/voxel.glsl describes.
struct VoxelSide {
  glm::vec3 position{0};  // average over the side's surface, world space
  float area = 0;         // m^2 of surface; 0 if the side is empty
  glm::vec3 normal{0};    // average, unit
  float object = 0;
  glm::vec3 reflectance{0};
  // For an object that deforms: the triangle with the largest piece in the side, counted from the first non-static one.
  float triangle = 0;
  glm::vec3 emission{0};  // W/(sr m^2)
  float unused1 = 0;
};
static_assert(sizeof(VoxelSide) == 64);

struct VoxelInfo {
  uint32_t voxels = 0, staticVoxels = 0, overflow = 0, resolution = 0;
};
static_assert(sizeof(VoxelInfo) == 16);

}  // namespace fovea::scene
