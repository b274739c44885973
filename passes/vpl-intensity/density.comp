// Strategies `pdf` and `constant`, first step: p_A, the density per surface area with which eye paths that start
// anywhere in the region land at the VPL. One work group per VPL.
//
// p_A is the mean over the region's points s of   cos_s cos_l V / (pi d^2 + cell^2):   the marginal over s, not the
// density from the one point that found the VPL. A VPL stands for the surface of a voxel, and 1 / (pi d^2 + a) is the
// form factor of a disc of area a, seen along its axis, divided by that area; so a point that happens to be close
// causes no spike. Points that show the background start no path.
//
// Most of the sum comes from the few close points, so many points are needed, but not a ray for each: an invocation
// sums its share without V and traces one ray, to a point drawn in proportion to the terms, which stays the same as
// long as nothing moves. Its share times V of that point has the correct mean. V is evaluated in the voxels, as for
// the paths that found the VPLs. Define: ONCE 0/1, 1 to skip the work once the total of `constant` is known.
#include "scene/scene.glsl"
#include "sampling/random.glsl"
#include "vpl-intensity/vpl_intensity.glsl"
#include "vpl-intensity/visible.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
uniform samplerBuffer screen;
layout(std430) writeonly buffer DensitiesBlock { float list[]; } densities;
#if ONCE
layout(std430) readonly buffer KeptBlock { Kept value; } kept;
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  uint points;
};

shared float sums[64];

const uint kDensityStream = 0x64656e73u;

// Density of a path from a screen point that nothing blocks.
float landing(VoxelGrid grid, uint point, vec3 position, vec3 normal) {
  EyePathStart from = loadStart(screen, point);
  vec3 to = position - from.position;
  float d2 = dot(to, to);
  float cosines = max(dot(from.normal, to), 0.0) * max(-dot(normal, to), 0.0);
  float solid = kPi * d2 + grid.cell * grid.cell;
  return from.there > 0.0 && cosines > 1e-12 * d2 && d2 > 1e-12 ? cosines / (d2 * solid) : 0.0;
}

float seenShare(VoxelGrid grid, uint slot, uint lane, vec3 position, vec3 normal) {
  float sum = 0.0;
  for (uint i = lane; i < points; i += 64u) sum += landing(grid, i, position, normal);
  if (!(sum > 0.0)) return 0.0;
  float target = sum * uniformFloat(randomStream(0u, 0u, kDensityStream, 64u * slot + lane)), reached = 0.0;
  uint chosen = lane;
  for (uint i = lane; i < points; i += 64u) {
    float term = landing(grid, i, position, normal);
    if (term > 0.0 && reached <= target) chosen = i;
    reached += term;
  }
  EyePathStart from = loadStart(screen, chosen);
  return seesVpl(grid, from.position, from.face, position, normal) ? sum : 0.0;
}

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, lane = gl_LocalInvocationIndex;
  VplState vpl = loadVplState(vpls, min(slot, vplCount - 1u));
  bool wanted = vpl.life > 0.0;
#if ONCE
  wanted = wanted && kept.value.total == 0.0;
#endif
  sums[lane] = wanted ? seenShare(voxelsGrid(), slot, lane, vpl.position, vpl.normal) : 0.0;
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {  // a tree, so that the order is always the same
    if (lane < half_) sums[lane] += sums[lane + half_];
    barrier();
  }
  if (lane != 0u || slot >= vplCount) return;
  densities.list[slot] = sums[0] / float(points);
}
