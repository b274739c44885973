// VPLs as the shading passes read them, for every strategy: intensity B_l A_l / pi at the VPL's place.
// Define: SHARED 0/1: strategy `importance-area`.
#include "common/scene.glsl"
#include "weights/weights.glsl"

layout(local_size_x = 64) in;

layout(set = 0) uniform samplerBuffer vpls;
layout(set = 0) uniform samplerBuffer radiosity;
layout(set = 0, std430) readonly buffer AreasBlock { float list[]; } areas;
layout(set = 0, std430) writeonly buffer EmittersBlock { Vpl list[]; } emitters;
layout(set = 0, std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(set = 0, std430) buffer CountersBlock { uint alive, unseen, capped, givenSides; } counters;

#if SHARED
layout(set = 0) uniform samplerBuffer radiance;
layout(set = 0, std430) readonly buffer SumsBlock { uvec2 list[]; } sums;

// Mean light of the paths given to a VPL over its own, all of it when there are none. Direct light is that at the ends of
// the paths; for what comes by more bounces the VPL speaks for all of them.
float meanLight(uint slot, int side, float radiosity) {
  uvec2 sum = sums.list[slot];
  float own = side >= 0 && side < textureSize(radiance) ? kPi * texelFetch(radiance, side).w : 0.0;
  if (sum.x == 0u || !(own > 0.0) || !(radiosity > 0.0)) return 1.0;
  float direct = min(own / radiosity, 1.0);
  return 1.0 + direct * (float(sum.y) / (kLightUnits * float(sum.x)) - 1.0);
}
#endif

layout(push_constant) uniform Constants {
  uint vplCount;
  float offset;  // cells
};

// Neither infinite nor not a number; by its bits, as compilers may assume that comparisons never see either.
bool finite(vec4 x) { return all(notEqual(floatBitsToUint(x) & 0x7f800000u, uvec4(0x7f800000u))); }

const float kBrightest = 1e18;  // W/sr: far from any real light, and its products stay finite where it is shaded

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= vplCount) return;
  int first = int(slot) * kStateTexels;
  vec4 normalLife = texelFetch(vpls, first + 1);
  vec3 position = texelFetch(vpls, first).xyz;
  vec4 flux = vec4(texelFetch(radiosity, int(slot)).rgb, areas.list[slot]);
#if SHARED
  flux.rgb *= meanLight(slot, int(floatBitsToUint(texelFetch(vpls, first + 2).w)), texelFetch(radiosity, int(slot)).w);
#endif
  Vpl vpl = Vpl(vec4(0.0), vec4(0.0), vec4(0.0));
  if (normalLife.w > 0.0 && finite(vec4(position, 0.0)) && finite(normalLife) && finite(flux)) {
    vpl.positionArea = vec4(position + offset * voxelsGrid().cell * normalLife.xyz, flux.w);
    vpl.normal = vec4(normalLife.xyz, 0.0);
    vpl.intensity = vec4(clamp(flux.rgb * (flux.w * (1.0 / kPi)), vec3(0.0), vec3(kBrightest)), 0.0);
  }
  emitters.list[slot] = vpl;
  if (slot == 0u) counters.alive = totals.value.alive;
}
