// Strategy `importance-area`: how much each VPL matters, for pass manage in the next frame. A piece of surface sends
// the region the light p B per area, and VPLs should lie in proportion to it. With p_m the median of p_l, B_l the mean
// light of the VPL's own paths, B_m that of all paths, and f = kFloor,
//   w = p_l / p_m (B_l + f B_m) / (B_m + f B_m),   I = w / (1 + w).
// How many other VPLs are near changes neither p_l nor B_l, so new VPLs do not make those around them less important.
// As light counts relative to its mean, VPLs that stay dark when a door is opened matter less. One work group. Define:
// TRACED 0/1: with the light of pass eye-paths.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
uniform samplerBuffer densities;
#if TRACED
LARGE_TEXELS(vec4, tracedEnds);
#endif
layout(std430) readonly buffer SumsBlock { PathSum list[]; } sums;
layout(std430) readonly buffer SitesBlock { VplSite list[]; } sites;
layout(std430) readonly buffer KeptBlock { Kept value; } kept;
layout(std430) writeonly buffer WorthBlock { float list[]; } worth;

layout(push_constant) uniform Constants {
  uint vplCount;
};

const float kFloor = 0.25;  // in means of the light, for what the paths have not found, as `light_floor` of pass manage

shared vec2 sums_[64];

// Light of the paths of a VPL, and their number.
vec2 found(uint slot) {
  PathSum sum = sums.list[slot];
#if TRACED
  vec3 light = vec3(sum.lightX, sum.lightY, sum.lightZ) * loadEyePathEnd(tracedEnds, 0u).unit * kPathUnits;
  return vec2(luminanceOf(light), float(sum.paths));
#else
  return vec2(float(sum.lightX) * abs(sites.list[slot].light), float(sum.paths));
#endif
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  vec2 sum = vec2(0.0);
  for (uint i = lane; i < vplCount; i += 64u) sum += found(i);
  sums_[lane] = sum;
  barrier();
  for (uint half_ = 32u; half_ > 0u; half_ /= 2u) {
    if (lane < half_) sums_[lane] += sums_[lane + half_];
    barrier();
  }
  float mean = sums_[0].y > 0.0 ? sums_[0].x / sums_[0].y : 0.0;
  for (uint i = lane; i < vplCount; i += 64u) {
    vec2 own = found(i);
    float light = own.y > 0.0 ? own.x / own.y : abs(sites.list[i].light);
    float bright = mean > 0.0 ? (light / mean + kFloor) / (1.0 + kFloor) : 1.0;
    float seen = kept.value.median > 0.0 ? texelFetch(densities, int(i)).r / kept.value.median : 0.0;
    float w = loadVplState(vpls, i).life > 0.0 ? seen * min(bright, 1e6) : 0.0;
    worth.list[i] = w / (w + 1.0);
  }
}
