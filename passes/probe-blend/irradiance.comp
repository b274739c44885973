// Irradiance of probes: a cosine-weighted mean of the rays' radiance for each direction, blended with that of the
// previous frames (Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 8(2),
// 2019, section 4.2).
#include "device/texels.glsl"
#include "probes/layout.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform RaysGridBlock { ProbeGrid value; } raysGrid;
uniform samplerBuffer raysDirections;  // xyz: unit
LARGE_TEXELS(vec4, raysHits);  // rgb: radiance; a: distance, below 0 at backs, 0 if there is no ray
uniform texture2D historyIrradiance;
uniform samplerBuffer historyStates;
layout(rgba32f) uniform writeonly image2D probesIrradiance;

layout(push_constant) uniform Constants { float hysteresis, gamma, change, other; };

const float kLessKept = 0.15;  // section 4.2: what a large change takes from the hysteresis

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Relative change as the eye sees it, of fifth roots.
float changeOf(vec3 now, vec3 before) {
  vec3 a = pow(now, vec3(0.2)), b = pow(before, vec3(0.2));
  return largest(abs(a - b)) / max(largest(max(a, b)), 1e-6);
}

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(probesIrradiance)))) return;
  int probe = probeOfTexel(p, kIrradianceSide), rays = int(raysGrid.value.rays);
  vec3 before = texelFetch(historyIrradiance, p, 0).rgb, direction = probeDirection(p, kIrradianceSide);
  vec4 sum = vec4(0.0);
  for (int ray = probe < probesOf(raysGrid.value) ? 0 : rays; ray < rays; ++ray) {
    vec4 hit = texelOf(raysHits, probe * rays + ray);
    float weight = hit.a > 0.0 ? max(dot(texelFetch(raysDirections, ray).xyz, direction), 0.0) : 0.0;
    sum += weight * vec4(hit.rgb, 1.0);
  }
  vec3 now = sum.a > 0.0 ? sum.rgb / sum.a : before;
  float kept = keptAfter(loadProbe(historyStates, probe).frames, hysteresis);
  float changed = changeOf(now, before);
  kept = changed > other ? 0.0 : changed > change ? max(kept - kLessKept, 0.0) : kept;
  vec3 root = vec3(1.0 / gamma);
  vec3 blended = pow(mix(pow(now, root), pow(before, root), kept), vec3(gamma));
  imageStore(probesIrradiance, p, vec4(kept > 0.0 ? blended : now, 1.0));
}
