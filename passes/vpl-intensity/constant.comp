// Strategy `constant`: all VPLs have the same area, a constant total divided by the number of VPLs alive. The total
// is set on the first frame that has any flux, so that all VPLs together emit as much as with the areas of the
// densities (which pdf.comp has put into `areas`): T = alive * sum B_l A_l / sum B_l, in luminance. One work group.
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
uniform samplerBuffer radiosity;
layout(std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(std430) buffer AreasBlock { float list[]; } areas;
layout(std430) buffer KeptBlock { Kept value; } kept;

layout(push_constant) uniform Constants { uint vplCount; };

shared vec2 sums[64];

void main() {
  uint lane = gl_LocalInvocationIndex;
  float alive = float(totals.value.alive), total = kept.value.total;
  vec2 sum = vec2(0.0);
  if (total == 0.0)
    for (uint i = lane; i < vplCount; i += 64u) {
      float b = texelFetch(radiosity, int(i)).w;
      if (b > 0.0 && b < 1e20) sum += b * vec2(areas.list[i], areas.list[i] > 0.0 ? 1.0 : 0.0);
    }
  sums[lane] = sum;
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {
    if (lane < half_) sums[lane] += sums[lane + half_];
    barrier();
  }
  if (total == 0.0 && sums[0].y > 0.0) total = alive * sums[0].x / sums[0].y;
  barrier();
  for (uint i = lane; i < vplCount; i += 64u)
    areas.list[i] = loadVplState(vpls, i).life > 0.0 ? total / max(alive, 1.0) : 0.0;
  if (lane == 0u) kept.value.total = total;
}
