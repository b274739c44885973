// The surface of a voxel side, as light-inject samples it. Needs voxels/voxel_trace.glsl.
#ifndef FOVEA_LIGHT_INJECT_PATCH_GLSL
#define FOVEA_LIGHT_INJECT_PATCH_GLSL

const uint kSidesPerGroup = 64u;

// The extent of a side's surface in its cell: two axes across it, one along the largest component of the normal. It
// reaches as far from the average position as the nearer wall of the cell in each axis, but covers no more than the
// side's area. This is exact for a surface that fills the cell or a part that begins at a wall of the cell, as at the
// edges and corners of planes.
struct Patch {
  vec3 u, v;    // half axes in the tangent plane, m
};

vec3 toAxes(uint axis, vec3 p) { return axis == 0u ? p.yzx : axis == 1u ? p.zxy : p; }
vec3 fromAxes(uint axis, vec3 p) { return axis == 0u ? p.zxy : axis == 1u ? p.yzx : p; }

Patch patchOf(VoxelGrid grid, VoxelSide side) {
  vec3 low = voxelToWorld(grid, floor(worldToVoxel(grid, side.position)));
  vec3 reach = max(min(side.position - low, low + grid.cell - side.position), 0.0);
  vec3 a = abs(side.normal);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  vec3 n = toAxes(axis, side.normal), r = toAxes(axis, reach);
  float widest = 4.0 * r.x * r.y / max(abs(n.z), 0.1);
  r.xy *= min(1.0, sqrt(side.area / max(widest, 1e-30)));
  vec2 rise = -n.xy / (n.z >= 0.0 ? max(n.z, 0.1) : min(n.z, -0.1));
  return Patch(fromAxes(axis, vec3(r.x, 0.0, r.x * rise.x)), fromAxes(axis, vec3(0.0, r.y, r.y * rise.y)));
}

#endif
