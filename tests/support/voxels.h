// A plain CPU voxeliser, whose result pass `voxelize` must reproduce, and voxels for the tests of passes
// that read them.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/scene.h"
#include "tests/references/voxel_grid.h"

namespace fovea::test {

// The bundle "voxels" as arrays; see shaders/voxels/voxel.glsl.
struct VoxelArrays {
  scene::VoxelGrid grid;
  int resolution = 1;
  std::vector<uint32_t> index;            // resolution^3, x fastest: 0 empty, else 1 + voxel
  std::vector<scene::VoxelSide> surface;  // 2 per voxel
  scene::VoxelInfo info;

  uint32_t voxelAt(glm::ivec3 cell) const {  // 0 empty, else 1 + voxel
    return index[size_t(cell.x) +
                 size_t(resolution) * (size_t(cell.y) + size_t(resolution) * size_t(cell.z))];
  }
};

// Voxelises static triangles and then those of dynamic objects, which hide the static voxel of their cell. The
// float operations and their order are those of shaders/voxelize, so that the set of voxels and sides is equal,
// not merely close.
VoxelArrays voxelizeReference(const scene::Scene& scene, const scene::Geometry& geometry, int resolution);

// Member `occupied`: one bit for each cell with a voxel, one word for each brick of 4 x 4 x 2 cells.
std::vector<uint32_t> occupiedBricks(const VoxelArrays& voxels);

// Uploads the members of `voxels` that the pass reads.
void setVoxels(PassTest& test, const VoxelArrays& voxels);

}  // namespace fovea::test
