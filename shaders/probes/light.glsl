// The light of probes at a point (Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 2019, section 5, with the bias of Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global
// Illumination for Production", JCGT 2021, section 3).
//
// Needs the port `probes` of bundle `probes`.
#include "device/language.glsl"
#include "probes/layout.glsl"

TEXTURE(texture2D, probesIrradiance);   // irradiance / pi
TEXTURE(texture2D, probesDistance);     // mean distance and mean squared distance, m, m^2
TEXTURE(samplerBuffer, probesStates);   // Probe

// Bilinear interpolation between the four texels around a place, in texels from the centre of the first one. Devices
// need not filter 32-bit formats.
vec4 between(texture2D image, vec2 place) {
  ivec2 p = ivec2(floor(place));
  vec2 f = place - vec2(p);
  vec4 top = mix(texelFetch(image, p, 0), texelFetch(image, p + ivec2(1, 0), 0), f.x);
  vec4 bottom = mix(texelFetch(image, p + ivec2(0, 1), 0), texelFetch(image, p + ivec2(1, 1), 0), f.x);
  return mix(top, bottom, f.y);
}

// Weight for the chance that a probe sees a point at this distance, m, in this direction, by Chebyshev's inequality.
float chanceSeen(int probe, vec3 direction, float distance) {
  vec2 seen = vec2(between(probesDistance, probePlace(probe, kDistanceSide, direction)));
  float variance = abs(seen.y - seen.x * seen.x), behind = distance - seen.x;
  if (!(behind > 0.0)) return 1.0;
  float chance = variance / (variance + behind * behind);
  return max(chance * chance * chance, 0.05);
}

// Irradiance / pi, W/(sr m^2), at a point: world space, m; normal, towardsEye: unit. bias: how far points are moved off
// their surface, in spacings of the grid.
vec3 probeLight(ProbeGrid grid, float bias, vec3 position, vec3 normal, vec3 towardsEye) {
  vec3 moved = position + bias * grid.spacing * (0.2 * normal + 0.8 * towardsEye);
  ivec3 last = ivec3(grid.columns, grid.rows, grid.layers) - 1;
  vec3 place = clamp((moved - grid.origin) / grid.spacing, vec3(0.0), vec3(last));
  ivec3 first = min(ivec3(place), max(last - 1, 0));
  vec3 between_ = place - vec3(first);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 8; ++i) {
    ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
    int probe = probeAt(grid, min(first + corner, last));
    Probe state = loadProbe(probesStates, probe);
    vec3 stands = grid.origin + grid.spacing * vec3(min(first + corner, last)) + state.offset;
    float facing = 0.5 * dot(normalize(stands - position), normal) + 0.5;
    vec3 to = moved - stands;
    float distance = length(to);
    float weight = (facing * facing + 0.2) * chanceSeen(probe, to / max(distance, 1e-6), distance);
    if (weight < 0.2) weight *= weight * weight / (0.2 * 0.2);  // what is nearly nothing counts even less
    vec3 linear = mix(1.0 - between_, between_, vec3(corner));
    weight *= max(linear.x * linear.y * linear.z, 1e-6);
    if (state.inside > 0.0) weight = 0.0;
    sum += weight * vec4(vec3(between(probesIrradiance, probePlace(probe, kIrradianceSide, normal))), 1.0);
  }
  return sum.a > 0.0 ? vec3(sum) / sum.a : vec3(0.0);
}
