// What probes see in which direction: the mean distance and its square for each direction, of the rays around it,
// blended with those of the previous frames (Majercik et al. 2019, sections 4.2 and 4.3).
#include "device/texels.glsl"
#include "probes/layout.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform RaysGridBlock { ProbeGrid value; } raysGrid;
uniform samplerBuffer raysDirections;  // xyz: unit
LARGE_TEXELS(vec4, raysHits);  // a: distance, below 0 at backs, 0 if there is no ray
uniform texture2D historyDistance;
uniform samplerBuffer historyStates;
layout(rg32f) uniform writeonly image2D probesDistance;

layout(push_constant) uniform Constants { float hysteresis, sharpness; };

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(probesDistance)))) return;
  int probe = probeOfTexel(p, kDistanceSide), rays = int(raysGrid.value.rays);
  vec3 direction = probeDirection(p, kDistanceSide);
  float reach = probeReach(raysGrid.value);
  vec3 sum = vec3(0.0);
  for (int ray = probe < probesOf(raysGrid.value) ? 0 : rays; ray < rays; ++ray) {
    float hit = texelOf(raysHits, probe * rays + ray).a, seen = min(abs(hit), reach);
    float cosine = max(dot(texelFetch(raysDirections, ray).xyz, direction), 0.0);
    sum += (hit != 0.0 ? pow(cosine, sharpness) : 0.0) * vec3(seen, seen * seen, 1.0);
  }
  vec2 before = texelFetch(historyDistance, p, 0).rg, now = sum.z > 0.0 ? sum.xy / sum.z : before;
  float kept = keptAfter(loadProbe(historyStates, probe).frames, hysteresis);
  imageStore(probesDistance, p, vec4(mix(now, before, kept), 0.0, 0.0));
}
