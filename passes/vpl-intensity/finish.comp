// VPLs as the shading passes read them, for every strategy: intensity B_l A_l / pi at the VPL's position. Defines:
// SHARED 0/1: strategy `importance-area`; TRACED 0/1: with the light of pass eye-paths; GAINS 0/1: with the factors
// from discs.comp; NEAR 0/1: no disc is smaller than pass near-field specifies.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpl-intensity/vpl_intensity.glsl"
#include "device/finite.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer placed;
layout(std430) readonly buffer AreasBlock { float list[]; } areas;
layout(std430) writeonly buffer EmittersBlock { Vpl list[]; } emitters;
layout(std430) readonly buffer TotalsBlock { Totals value; } totals;
#if NEAR
uniform samplerBuffer spread;  // x: area, m^2
#endif
layout(std430) buffer CountersBlock { uint alive; } counters;

#if GAINS
layout(std430) readonly buffer GainsBlock { float list[]; } gains;
#endif
#if TRACED
LARGE_TEXELS(vec4, tracedEnds);
uniform samplerBuffer densities;
layout(std430) readonly buffer SumsBlock { PathSum list[]; } sums;

// Intensity of a VPL of area `area` that emits as its paths do on average; one that the region does not see
// emits its own light.
vec3 intensityOf(uint slot, vec3 own, float area) {
  PathSum sum = sums.list[slot];
  vec3 light = vec3(sum.lightX, sum.lightY, sum.lightZ) * loadEyePathEnd(tracedEnds, 0u).unit * kPathUnits;
  if (!(texelFetch(densities, int(slot)).r > 0.0)) return own * area;
  return sum.paths > 0u ? light / float(sum.paths) * area : vec3(0.0);
}
#elif SHARED
uniform usamplerBuffer vpls;
uniform samplerBuffer radiosity;
LARGE_TEXELS(vec4, radiance);
layout(std430) readonly buffer SumsBlock { PathSum list[]; } sums;

// Mean light of the paths assigned to a VPL relative to its own, or all of its own if there are none. Direct light is
// that at the ends of the paths; for light from further bounces the VPL stands for all of them.
float meanLight(uint slot, int side, float radiosity) {
  PathSum sum = sums.list[slot];
  float own = side >= 0 && side < texelsIn(radiance) ? kPi * texelOf(radiance, side).w : 0.0;
  if (sum.paths == 0u || !(own > 0.0) || !(radiosity > 0.0)) return 1.0;
  float direct = min(own / radiosity, 1.0);
  return 1.0 + direct * (float(sum.lightX) / float(sum.paths) - 1.0);
}

vec3 intensityOf(uint slot, vec3 own, float area) {
  int side = int(loadVplState(vpls, slot).side);
  return own * (area * meanLight(slot, side, texelFetch(radiosity, int(slot)).w));
}
#else
vec3 intensityOf(uint slot, vec3 own, float area) { return own * area; }
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
};

const float kBrightest = 1e18;  // W/sr: far above any real light, and products in the shading stay finite

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= vplCount) return;
  Vpl place = loadVpl(placed, slot), vpl = kNoVpl;
  float area = areas.list[slot];
  vec3 intensity = intensityOf(slot, place.intensity, area);
#if GAINS
  intensity *= gains.list[slot];
#endif
  if (place.area > 0.0 && finite(vec4(intensity, area))) {
#if NEAR
    area = max(area, texelFetch(spread, 0).x);
#endif
    vpl = place;
    vpl.area = area;
    vpl.intensity = clamp(intensity, vec3(0.0), vec3(kBrightest));
  }
  emitters.list[slot] = vpl;
  if (slot == 0u) counters.alive = totals.value.alive;
}
