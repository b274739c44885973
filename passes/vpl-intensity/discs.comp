// Strategy `importance-area` with the kernel `disc`, second to last step: the disc of a VPL's own area sends less
// light to nearby points of the region than the disc of a voxel would. Finds how much brighter the VPL must be to
// make up for that. One work group per VPL. NEAR 1: no disc is smaller than `spread`, for which pass near-field
// compensates; the paths were assigned without that light. The factor is then at most kMostGain, as a VPL that
// lights only a crack would be a bright spot there. What this cuts off is lost.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"
#include "vpl-intensity/landing.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer placed;
uniform samplerBuffer densities;
LARGE_TEXELS(uint, seen);
layout(std430) readonly buffer AreasBlock { float list[]; } areas;
layout(std430) writeonly buffer GainsBlock { float list[]; } gains;
#if NEAR
uniform samplerBuffer spread;  // x: area, m^2
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  uint points;
  float areaCap;
};

shared float sums[64];

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, lane = gl_LocalInvocationIndex;
  bool inside = slot < vplCount;
  slot = min(slot, vplCount - 1u);
  float before = texelFetch(densities, int(slot)).r, area = areas.list[slot], sum = 0.0;
  if (before > 0.0 && area > 0.0) {
    Vpl vpl = loadVpl(placed, slot);
#if NEAR
    area = max(area, texelFetch(spread, 0).x);
#endif
    uint word = (slot * 64u + lane) * laneWords(points), bits = 0u, turn = 0u;
    for (uint i = lane; i < points; i += 64u, ++turn) {
      if ((turn & 31u) == 0u) bits = texelOf(seen, int(word + turn / 32u)).r;
      float p = landing(i, vpl.position, vpl.normal, area, 0.0);
      sum += (bits >> (turn & 31u) & 1u) != 0u ? p : 0.0;
    }
  }
  sums[lane] = sum;
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {  // a tree, so that the order is always the same
    if (lane < half_) sums[lane] += sums[lane + half_];
    barrier();
  }
  float after = sums[0] / float(points);
  float most = NEAR != 0 ? kMostGain : areaCap;
  if (lane == 0u && inside) gains.list[slot] = after > 0.0 ? min(before / after, most) : 1.0;
}
