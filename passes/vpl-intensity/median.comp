// The median density of the VPLs that are seen, the reference for "hardly seen at all". One work group. SHARED 1,
// strategy `importance-area`: marks the VPLs with a density below median / areaCap, see share.comp. If no VPL is seen
// at all (the region shows the background), the median of the last frame that had one is used.
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer densities;
layout(std430) buffer KeptBlock { Kept value; } kept;
#if SHARED
layout(std430) buffer SitesBlock { VplSite list[]; } sites;
uniform samplerBuffer seenFrom;
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  float areaCap;
};

shared uint counts[64];

// VPLs with a density above 0 and at most `most`.
uint countSeen(float most) {
  uint lane = gl_LocalInvocationIndex, n = 0u;
  for (uint i = lane; i < vplCount; i += 64u) {
    float p = texelFetch(densities, int(i)).r;
    n += uint(p > 0.0 && p <= most);
  }
  barrier();
  counts[lane] = n;
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {
    if (lane < half_) counts[lane] += counts[lane + half_];
    barrier();
  }
  return counts[0];
}

// The smallest density that at least half of the seen VPLs do not exceed, 0 if none is seen. Found by bisection on
// the bits, which are ordered as the numbers are.
float medianDensity() {
  uint infinity = 0x7f800000u, seen = countSeen(uintBitsToFloat(infinity - 1u)), low = 0u, high = infinity - 1u;
  if (seen == 0u) return 0.0;
  for (int step_ = 0; step_ < 31 && low < high; ++step_) {
    uint middle = low + (high - low) / 2u;
    if (2u * countSeen(uintBitsToFloat(middle)) >= seen)
      high = middle;
    else
      low = middle + 1u;
  }
  return uintBitsToFloat(high);
}

void main() {
  float before = kept.value.median, median = medianDensity();
  if (!(median > 0.0)) median = before;
  barrier();
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u) kept.value.median = median;
#if SHARED
  for (uint i = lane; i < vplCount; i += 64u) {
    float p = texelFetch(densities, int(i)).r, handicap = sites.list[i].handicap;
    float part = partKept(p, median / areaCap, texelFetch(seenFrom, int(i)).r);
    if (p > 0.0 && part < 1.0 && handicap >= 0.0) sites.list[i].handicap = kThinSite - handicap;
  }
#endif
}
