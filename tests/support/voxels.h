// The voxeliser on the CPU, plain loops: what pass `voxelize` must produce, and voxels for the tests of
// passes that read them.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/scene.h"
#include "framework/shader_twins/voxel_grid.h"

namespace fovea::test {

// The bundle "voxels" as arrays, see shaders/common/voxel.glsl.
struct VoxelArrays {
  scene::VoxelGrid grid;
  int resolution = 1;
  std::vector<uint32_t> index;            // resolution^3, x fastest: 0 empty, else 1 + voxel
  std::vector<scene::VoxelSide> surface;  // 2 a voxel
  scene::VoxelInfo info;

  uint32_t voxelAt(glm::ivec3 cell) const {  // 0 empty, else 1 + voxel
    return index[size_t(cell.x) +
                 size_t(resolution) * (size_t(cell.y) + size_t(resolution) * size_t(cell.z))];
  }
};

// Static triangles, then those of dynamic objects, which hide the static voxel of their cell. The same float
// operations in the same order as shaders/voxelize, so that the set of voxels and sides is equal, not merely
// close.
VoxelArrays voxelizeReference(const scene::Scene& scene, const scene::Geometry& geometry, int resolution);

// Member `occupied`: a bit for each cell with a voxel, a word for each brick of 4 x 4 x 2 cells.
std::vector<uint32_t> occupiedBricks(const VoxelArrays& voxels);

// Uploads the members of `voxels` that the pass reads.
void setVoxels(PassTest& test, const VoxelArrays& voxels);

}  // namespace fovea::test
