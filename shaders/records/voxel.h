// The voxel grid in which VPLs are found, and the records of the bundle `voxels`, which voxels/voxel.glsl describes.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// Cubic cells, `resolution` of them along the longest axis of the scene's bounds; the volume is a cube of cells.
struct VoxelGrid {
  vec3 origin SHARED_ZERO;       // world space, m, corner of cell (0, 0, 0)
  float cell SHARED_DEFAULT(1);  // edge, m
  int resolution SHARED_DEFAULT(1);

#ifdef __cplusplus
  vec3 worldToVoxel(vec3 position) const { return (position - origin) / cell; }
  vec3 voxelToWorld(vec3 voxel) const { return origin + voxel * cell; }
#endif
};

// Bricks of this many cells share a texel of the member `occupied`.
SHARED_CONSTANT int kBrickWidth = 4, kBrickHeight = 4, kBrickDepth = 2;

SHARED_CONSTANT uint kNoSide = 0xffffffffu;  // in place of the number of a side: there is none

// One side of a voxel: averages over the surface in it (passes/geometry.md, voxelize).
struct VoxelSide {
  vec3 position SHARED_ZERO;  // world space, m
  float area SHARED_ZERO;     // m^2 of surface; 0 if the side is empty
  vec3 normal SHARED_ZERO;    // unit
  float object SHARED_ZERO;
  vec3 reflectance SHARED_ZERO;
  // For an object that deforms: the triangle with the largest piece in the side, counted from the first non-static one.
  float triangle SHARED_ZERO;
  vec3 emission SHARED_ZERO;       // W/(sr m^2), averaged over emissionArea
  float emissionArea SHARED_ZERO;  // m^2 where rays can hit the side; 0 without emission
};
SHARED_SIZE(VoxelSide, 64)
SHARED_OFFSET(VoxelSide, emission, 48)

// Sizes of the list of voxels.
struct VoxelInfo {
  uint voxels SHARED_ZERO;        // in the list
  uint staticVoxels SHARED_ZERO;  // number of the leading static ones
  uint overflow SHARED_ZERO;      // voxels for which there was no room
  uint resolution SHARED_ZERO;    // R
};
SHARED_SIZE(VoxelInfo, 16)

// ---- Rays through the voxels (voxels/voxel_trace.glsl) ----

// Smallest distance of a hit from the plane on which the ray starts, in cells. Voxels of the same surface protrude
// from its plane by rounding only (the average position of a plane lies on it), curved ones by a little.
SHARED_CONSTANT float kOwnSurface = 0.25f;

// A voxel's surface is a piece of the plane through the side's average position, so a ray that passes through the
// cell beside it has not hit it. It is hit if the ray leaves the cell behind the plane (or almost, in cells) and no
// farther from the position than this many radii of a disc of the side's area. Of diffuse bounces in Sponza (128^3
// voxels) 82% end within 1.5 cells of where a ray through the triangles ends, in the Cornell box 99%; if any side
// that faces the ray stopped it, 59% and 95% would.
SHARED_CONSTANT float kBehindPlane = 0.1f;
SHARED_CONSTANT float kSideRadii = 1.5f;

// What a ray meets.
struct VoxelHit {
  uint side SHARED_DEFAULT(kNoSide);  // kNoSide if the ray leaves the grid
  float distance SHARED_ZERO;         // along the ray to the side's plane, kept within the voxel, m
};

SHARED_END
