// Strategies `pdf` and `constant`, first step: p_A, the density per area of surface with which eye paths that start anywhere
// in the region land where the VPL is. One work group a VPL.
//
// p_A is the mean over the region's points s of   cos_s cos_l V / (pi d^2 + cell^2):   the marginal over s, not the density
// from the one point that found the VPL. A VPL stands for the surface of a voxel: 1 / (pi d^2 + a) is the form factor of a
// disc of area a, seen along its axis, over that area; so a point that happens to lie close by makes no spike. Points that
// show the background start no path.
// Defines: ONCE 0/1: not once the total of `constant` is known.
#include "common/scene.glsl"
#include "weights/weights.glsl"
#include "weights/visible.glsl"

layout(local_size_x = 64) in;

layout(set = 0) uniform samplerBuffer vpls;
layout(set = 0) uniform samplerBuffer screen;
layout(set = 0, std430) writeonly buffer DensitiesBlock { float list[]; } densities;

#if ONCE
layout(set = 0, std430) readonly buffer KeptBlock { float total, median; } kept;
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  uint points;
};

shared float sums[64];

float landing(VoxelGrid grid, int point, vec3 position, vec3 normal) {
  vec4 from = texelFetch(screen, 3 * point);
  vec3 to = position - from.xyz;
  float d2 = dot(to, to);
  float cosines = max(dot(texelFetch(screen, 3 * point + 1).xyz, to), 0.0) * max(-dot(normal, to), 0.0);
  if (!(from.w > 0.0 && cosines > 1e-12 * d2 && d2 > 1e-12)) return 0.0;
  vec3 face = texelFetch(screen, 3 * point + 2).xyz;
  if (!seesVpl(grid, from.xyz, face, position, normal)) return 0.0;
  return cosines / (d2 * (kPi * d2 + grid.cell * grid.cell));
}

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, lane = gl_LocalInvocationIndex;
  int first = int(min(slot, vplCount - 1u)) * kStateTexels;
  vec3 position = texelFetch(vpls, first).xyz;
  vec4 normalLife = texelFetch(vpls, first + 1);
  VoxelGrid grid = voxelsGrid();
  float sum = 0.0;
  bool wanted = normalLife.w > 0.0;
#if ONCE
  wanted = wanted && kept.total == 0.0;
#endif
  if (wanted)
    for (uint i = lane; i < points; i += 64u) sum += landing(grid, int(i), position, normalLife.xyz);
  sums[lane] = sum;
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {  // a tree: the same order every time
    if (lane < half_) sums[lane] += sums[lane + half_];
    barrier();
  }
  if (lane == 0u && slot < vplCount) densities.list[slot] = sums[0] / float(points);
}
