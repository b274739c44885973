// VPLs as the shading passes read them, for every strategy: intensity B_l A_l / pi at the VPL's place.
#include "common/scene.glsl"
#include "weights/weights.glsl"

layout(local_size_x = 64) in;

layout(set = 0) uniform samplerBuffer vpls;
layout(set = 0) uniform samplerBuffer radiosity;
layout(set = 0, std430) readonly buffer AreasBlock { float list[]; } areas;
layout(set = 0, std430) writeonly buffer EmittersBlock { Vpl list[]; } emitters;
layout(set = 0, std430) readonly buffer TotalsBlock { Totals value; } totals;
layout(set = 0, std430) buffer CountersBlock { uint alive, unseen, capped, givenSides; } counters;

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
  Vpl vpl = Vpl(vec4(0.0), vec4(0.0), vec4(0.0));
  if (normalLife.w > 0.0 && finite(vec4(position, 0.0)) && finite(normalLife) && finite(flux)) {
    vpl.positionArea = vec4(position + offset * voxelsGrid().cell * normalLife.xyz, flux.w);
    vpl.normal = vec4(normalLife.xyz, 0.0);
    vpl.intensity = vec4(clamp(flux.rgb * (flux.w * (1.0 / kPi)), vec3(0.0), vec3(kBrightest)), 0.0);
  }
  emitters.list[slot] = vpl;
  if (slot == 0u) counters.alive = totals.value.alive;
}
