// Strategy `pdf`: A_l = 1 / (N p_A(x_l)). One work group.
// SHARED 1, strategy `importance-area`: n / (M p_A(x_l)) with n of M eye paths given to the VPL (share.comp).
//
// N is the number of eye paths that the list stands for: the VPLs alive, plus the paths that escaped, in proportion.
//
// No density counts as less than the median's areaCap-th part. Without that bound the few VPLs that hardly any point sees,
// and whose density is mostly error, would shine through everything; the contribution of a VPL to the region's mean,
// B_l A_l p_l, is cut only below it. A VPL that no point sees (an old one, out of the region) gets the largest area: it
// cannot change the region's mean, and a weight that jumped to 0 would flicker where the rest of the image shows its light.
// When no VPL is seen at all (the region shows the background) the median of the last frame that had one stands in.
#include "common/scene.glsl"
#include "weights/weights.glsl"

layout(local_size_x = 64) in;

layout(set = 0) uniform samplerBuffer vpls;
layout(set = 0) uniform samplerBuffer densities;
layout(set = 0, std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(set = 0, std430) writeonly buffer AreasBlock { float list[]; } areas;
layout(set = 0, std430) buffer KeptBlock { float total, median; } kept;
#if SHARED
layout(set = 0, std430) readonly buffer SumsBlock { uvec2 list[]; } sums;
#endif
layout(set = 0, std430) buffer CountersBlock { uint alive, unseen, capped, givenSides; } counters;

layout(push_constant) uniform Constants {
  uint vplCount;
  uint tried;  // as Totals::found, had none escaped
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

// The smallest density that at least half of the seen VPLs do not exceed, 0: none is seen. By bisection on the bits, which
// are ordered as the numbers are.
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
  uint lane = gl_LocalInvocationIndex;
  float before = kept.median, median = medianDensity();
  if (!(median > 0.0)) median = before;
  float found = float(totals.value.alive);
  if (totals.value.found > 0u) found *= float(tried) / float(totals.value.found);
  float least = median / areaCap;
  uint unseen = 0u, capped = 0u;
  for (uint i = lane; i < vplCount; i += 64u) {
    bool there = texelFetch(vpls, int(i) * kStateTexels + 1).w > 0.0;
    float p = texelFetch(densities, int(i)).r;
    areas.list[i] = there && least > 0.0 ? 1.0 / (found * max(p, least)) : 0.0;
#if SHARED
    if (there && p > 0.0) areas.list[i] = float(sums.list[i].x) / (float(tried) * max(p, least));
#endif
    unseen += uint(there && !(p > 0.0));
    capped += uint(there && p > 0.0 && p < least);
  }
  if (unseen > 0u) atomicAdd(counters.unseen, unseen);
  if (capped > 0u) atomicAdd(counters.capped, capped);
  barrier();
  if (lane == 0u) kept.median = median;
}
