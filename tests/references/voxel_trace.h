// Rays through the voxels, as a plain reference for shaders/voxels/voxel_trace.glsl, which explains the method.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "shaders/records/voxel.h"
#include "tests/references/voxel_grid.h"

namespace fovea::scene {

// The bundle "voxels" as arrays. index: R^3 words, x fastest; surface: two sides per voxel.
struct Voxels {
  VoxelGrid grid;
  std::span<const uint32_t> index;
  std::span<const VoxelSide> surface;

  bool inside(glm::ivec3 cell) const {
    return std::min({cell.x, cell.y, cell.z}) >= 0 && std::max({cell.x, cell.y, cell.z}) < grid.resolution;
  }
  // Number of the voxel in a cell plus 1; 0 if the cell is empty or outside the grid.
  uint32_t at(glm::ivec3 cell) const {
    const size_t r = size_t(grid.resolution);
    return inside(cell) ? index[size_t(cell.x) + r * (size_t(cell.y) + r * size_t(cell.z))] : 0u;
  }
};

enum class Meeting { None, Passed, Met };

inline Meeting meetsSide(const Voxels& voxels, uint32_t side, glm::vec3 origin, glm::vec3 direction,
                         glm::vec3 normal, float exit, float& facing, float& distance) {
  const VoxelSide& s = voxels.surface[side];
  const float cell = voxels.grid.cell;
  const glm::vec3 to = s.position - origin;
  const float height = glm::dot(to, s.normal);
  facing = glm::dot(s.normal, direction);
  distance = facing < 0.0f ? height / facing : 0.0f;
  if (!(s.area > 0.0f && facing < 0.0f && glm::dot(to, normal) > kOwnSurface * cell)) return Meeting::None;
  const glm::vec3 off = std::min(distance, exit) * direction - to;
  const bool met = exit * facing - height < kBehindPlane * cell &&
                   3.14159265f * glm::dot(off, off) < kSideRadii * kSideRadii * s.area;
  return met ? Meeting::Met : Meeting::Passed;
}

// Whether a ray that crosses the plane of a side at `place`, in its cell or beyond, slips through its surface.
inline bool slipsThrough(const Voxels& voxels, glm::ivec3 cell, const VoxelSide& s, glm::vec3 place,
                         bool beyond) {
  glm::vec3 off = place - s.position;
  if (beyond) return 3.14159265f * glm::dot(off, off) < kSideRadii * kSideRadii * s.area;
  off -= glm::dot(off, s.normal) * s.normal;
  const glm::vec3 size = glm::abs(off);
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 next = cell;
    next[axis] += off[axis] > 0 ? 1 : off[axis] < 0 ? -1 : 0;
    if (size[axis] > 0.5f * std::max({size.x, size.y, size.z}) && voxels.at(next) != 0u) return true;
  }
  return false;
}

// First side along a ray. origin, direction (unit) and normal are in world space; `normal` is that of the surface on
// which the ray starts, on the side to which the ray goes. far: cells that the ray enters beyond this distance (m)
// are ignored. The shader explains the method.
inline VoxelHit traceVoxels(const Voxels& voxels, glm::vec3 origin, glm::vec3 direction, glm::vec3 normal,
                            float far = 1e30f) {
  const VoxelGrid& grid = voxels.grid;
  const glm::vec3 p = grid.worldToVoxel(origin);
  const float size = float(grid.resolution), length2 = glm::dot(direction, direction);
  if (!(glm::dot(glm::abs(p), glm::vec3(1.0f)) < 1e6f && length2 > 0.5f && length2 < 2.0f)) return {};

  glm::vec3 inverse(0.0f), never(1e30f), ahead(0.0f);
  glm::ivec3 stride(0);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) > 1e-7f) {
      inverse[k] = 1.0f / direction[k];
      never[k] = 0.0f;
      stride[k] = direction[k] > 0.0f ? 1 : -1;
    } else if (p[k] < 0.0f || p[k] > size) {
      return {};
    }
    ahead[k] = direction[k] > 0.0f ? 1.0f : 0.0f;
  }
  const glm::vec3 wallA = -p * inverse, wallB = (size - p) * inverse;
  const glm::vec3 enter = glm::min(wallA, wallB) - never, leave = glm::max(wallA, wallB) + never;
  float t = std::max({enter.x, enter.y, enter.z, 0.0f});
  if (t > std::min({leave.x, leave.y, leave.z})) return {};

  glm::ivec3 cell =
      glm::clamp(glm::ivec3(glm::floor(p + t * direction)), glm::ivec3(0), glm::ivec3(grid.resolution - 1));
  VoxelHit slipped;  // the last side through which the ray slipped, see the shader
  float front = -1.0f;
  for (int turn = 0; turn < 3 * grid.resolution + 3; ++turn) {
    const uint32_t voxel = voxels.at(cell);
    const glm::vec3 walls = (glm::vec3(cell) + ahead - p) * inverse + never;
    const float next = std::min({walls.x, walls.y, walls.z});
    if (voxel != 0u) {
      const uint32_t side = 2u * (voxel - 1u);
      float facing[2], distance[2];
      const Meeting met0 =
          meetsSide(voxels, side, origin, direction, normal, next * grid.cell, facing[0], distance[0]);
      const Meeting met1 =
          meetsSide(voxels, side + 1u, origin, direction, normal, next * grid.cell, facing[1], distance[1]);
      const Meeting met = std::max(met0, met1);
      if (met != Meeting::None) {
        const uint32_t second = met1 > met0 || (met1 == met0 && facing[1] < facing[0]) ? 1u : 0u;
        const VoxelHit hit{side + second,
                           glm::clamp(distance[second], t * grid.cell, std::max(t, next) * grid.cell)};
        if (met == Meeting::Met) return hit;
        const float plane = distance[second];
        const bool beyond = plane > next * grid.cell;
        if (plane < t * grid.cell
                ? front == t
                : slipsThrough(voxels, cell, voxels.surface[hit.side], origin + plane * direction, beyond))
          slipped = hit;
        if (beyond) front = next;
      }
    }
    const int through = walls.x == next ? 0 : walls.y == next ? 1 : 2;
    cell[through] += stride[through];
    t = next;
    if (t * grid.cell > far) return {};
    if (!voxels.inside(cell)) break;
  }
  return slipped;
}

}  // namespace fovea::scene
