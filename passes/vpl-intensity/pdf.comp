// Strategy `pdf`: A_l = 1 / (N p_A(x_l)). SHARED 1, strategy `importance-area`: n / (M p_A(x_l)) with n of M eye
// paths assigned to the VPL (share.comp).
//
// N is the number of eye paths that the list stands for: the VPLs alive, plus the paths that escaped, in proportion.
//
// Densities are bounded below by median / areaCap. Without that bound the few VPLs that hardly any point sees, and
// whose density is mostly error, would be brighter than everything else. The contribution of a VPL to the region's
// mean, B_l A_l p_l, is reduced only below the bound (and in `importance-area` given to others, see share.comp). A VPL
// that no point sees (an old one, outside the region) gets the largest area: it cannot change the region's mean, and a
// weight that jumped to 0 would flicker where the rest of the image shows its light.
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
uniform samplerBuffer densities;
layout(std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(std430) writeonly buffer AreasBlock { float list[]; } areas;
layout(std430) readonly buffer KeptBlock { Kept value; } kept;
#if SHARED
layout(std430) readonly buffer SumsBlock { PathSum list[]; } sums;
#endif
layout(std430) buffer CountersBlock { uint alive, unseen, capped; } counters;

layout(push_constant) uniform Constants {
  uint vplCount;
  uint tried;  // value of Totals::found if no path escaped
  float areaCap;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= vplCount) return;
  float found = float(totals.value.alive), least = kept.value.median / areaCap;
  if (totals.value.found > 0u) found *= float(tried) / float(totals.value.found);
  bool there = loadVplState(vpls, i).life > 0.0;
  float p = texelFetch(densities, int(i)).r;
  float area = there && least > 0.0 ? 1.0 / (found * max(p, least)) : 0.0;
#if SHARED
  if (there && p > 0.0) area = float(sums.list[i].paths) / (kPathUnits * float(tried) * p);
#endif
  areas.list[i] = area;
  if (there && !(p > 0.0)) atomicAdd(counters.unseen, 1u);
  if (there && p > 0.0 && p < least) atomicAdd(counters.capped, 1u);
}
