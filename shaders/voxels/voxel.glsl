// The voxel grid in which VPLs are found, and the bundle `voxels`.
//
// Needs scene/scene.glsl.
#ifndef FOVEA_VOXEL_GLSL
#define FOVEA_VOXEL_GLSL

#include "device/exact.glsl"
#include "records/voxel.h"

// The grid over the scene's bounds with `resolution` cells along their longest axis.
VoxelGrid voxelGrid(uint resolution) {
  vec3 extent = max(frame.boundsMax - frame.boundsMin, vec3(0.0));
  float longest = max(max(extent.x, extent.y), max(extent.z, 1e-3));
  precise float pad = 1e-3 * longest;
  precise vec3 origin = frame.boundsMin - pad;
  precise float edge = longest + 2.0 * pad;
  return VoxelGrid(origin, quotient(edge, float(resolution)), int(resolution));
}

// Positions in world space, m, and in cells of the grid, and whether the grid has a cell.
vec3 worldToVoxel(VoxelGrid grid, vec3 position) { return (position - grid.origin) / grid.cell; }
vec3 voxelToWorld(VoxelGrid grid, vec3 voxel) { return grid.origin + voxel * grid.cell; }
bool insideGrid(VoxelGrid grid, ivec3 cell) {
  return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, ivec3(grid.resolution)));
}

// A voxel has two opposing sides. A surface belongs to side 1 when the largest component of its geometric normal is
// negative (ties: x before y before z), so that the faces of a thin wall fall on different sides.
uint voxelSideOf(vec3 normal) {
  vec3 a = abs(normal);
  float dominant = a.x >= a.y && a.x >= a.z ? normal.x : a.y >= a.z ? normal.y : normal.z;
  return dominant < 0.0 ? 1u : 0u;
}

// The bundle `voxels` (pass voxelize): an index volume and a compact list of the voxels that hold surface.
//   index    r32ui, R^3: 0 empty, else 1 + number of the voxel
//   occupied r32ui, a texel for each brick of kBrickCells: a bit for each cell that holds a voxel, see occupiedBit()
//   surface  VoxelSide; side = 2 * voxel + voxelSideOf(geometric normal)
//   info     VoxelInfo
// Voxels of static surfaces come first, ordered by linear cell index x + R (y + R z). Those of dynamic objects follow
// in the same order and hide the static voxel of their cell, as the volume refers to the dynamic one.
const ivec3 kBrickCells = ivec3(kBrickWidth, kBrickHeight, kBrickDepth);
ivec3 occupiedBrick(ivec3 cell) { return cell >> ivec3(2, 2, 1); }
uint occupiedBit(ivec3 cell) { return 1u << (cell.x & 3 | (cell.y & 3) << 2 | (cell.z & 1) << 4); }

// An empty side.
const VoxelSide kNoSurface = VoxelSide(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

#endif
