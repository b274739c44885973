// Does a point of a surface see a VPL, by the voxels? Needs weights/weights.glsl.
#ifndef FOVEA_VISIBLE_GLSL
#define FOVEA_VISIBLE_GLSL

// The ray's first hit counts as the VPL's voxel when it lies this close to it, in cells,
const float kNearby = 1.5;
// or is a part of the surface that the VPL lies on, that far off its tangent plane: a ray that comes in flat meets the
// layer of voxels long before its end. Against traced rays, weighted by the light they would carry, the first test alone
// loses 3% in the Cornell box and 22% in Sponza (128^3 cells), both together 1% and 17%; they gain 0% and 14% by leaks.
const float kSamePlane = 1.0;

bool seesSide(VoxelGrid grid, vec3 from, vec3 face, vec3 position, vec3 normal, uint side) {
  vec3 to = position - from;
  float d = length(to);
  VoxelHit hit = traceVoxels(grid, from, to / d, face);
  if (hit.side == side || hit.side == kNoSide || hit.distance >= d) return true;
  int first = int(hit.side) * kVoxelSideTexels;
  vec3 off = texelFetch(voxelsSurface, first).xyz - position;
  if (dot(off, off) < kNearby * kNearby * grid.cell * grid.cell) return true;
  return dot(texelFetch(voxelsSurface, first + 1).xyz, normal) > 0.5 && abs(dot(off, normal)) < kSamePlane * grid.cell;
}

#endif
