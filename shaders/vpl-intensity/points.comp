// The fixed screen points of the region from which densities are estimated: the R2 sequence (Roberts, "The
// Unreasonable Effectiveness of Quasirandom Sequences", 2018) over the box of the region, by rejection as in
// regionSample. They are the same in every frame, so that only changes in the scene change the intensities. TRACED 1:
// the surfaces that pass eye-paths saw from such points, some of them in earlier frames.
#include "common/scene.glsl"
#include "common/fovea.glsl"
#include "vpl-intensity/vpl_intensity.glsl"

layout(local_size_x = 64) in;

#if TRACED
uniform samplerBuffer tracedStarts;
#else
uniform texture2D gbufferPosition;
uniform texture2D gbufferNormal;
uniform texture2D gbufferFace;
#endif
layout(std430) writeonly buffer ScreenBlock { EyePathStart list[]; } screen;

#if TRACED
layout(push_constant) uniform Constants { uint points; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= points) return;
  screen.list[i] = loadStart(tracedStarts, i);
}
#else
layout(push_constant) uniform Constants {
  uint region;
  uint imageShare64ths;
  float foveaRadius;
  uint points;
};

const uint kPointsStream = 0x77656967u;

vec2 sequencePoint(uint i) {
  return vec2(uniformFloat(0x80000000u + i * 3242174889u), uniformFloat(0x80000000u + i * 2447445414u));
}

// Point i of the region takes points i, i + points, i + 2 points and so on of the sequence until one lies inside.
ivec2 regionPoint(uint part, uint i, Fovea fovea, ivec2 size) {
  vec2 high = vec2(size);
  if (part == kRegionImage) return clamp(ivec2(high * sequencePoint(i)), ivec2(0), size - 1);
  vec2 off = max(max(-fovea.centre, fovea.centre - high), vec2(0.0));
  vec2 reach = sqrt(max(fovea.radius * fovea.radius - off.yx * off.yx, 0.0));
  vec2 boxLow = max(vec2(0.0), fovea.centre - reach), boxHigh = min(high, fovea.centre + reach);
  if (dot(off, off) < fovea.radius * fovea.radius)
    for (uint k = 0u; k < kRegionTries; ++k) {
      vec2 position = mix(boxLow, boxHigh, sequencePoint(i + k * points)), d = position - fovea.centre;
      if (dot(d, d) <= fovea.radius * fovea.radius) return clamp(ivec2(position), ivec2(0), size - 1);
    }
  return regionSample(part, fovea, size, randomStream(0u, 0u, kPointsStream, i));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= points) return;
  ivec2 size = textureSize(gbufferPosition, 0);
  uint number, part = regionOf(region, imageShare64ths, i, number);
  ivec2 pixel = regionPoint(part, number, makeFovea(view.gaze, vec2(size), foveaRadius), size);
  vec4 position = texelFetch(gbufferPosition, pixel, 0);
  bool there = position.w > 0.0;
  vec3 normal = there ? normalize(texelFetch(gbufferNormal, pixel, 0).xyz) : vec3(0.0);
  vec3 face = octDecode(texelFetch(gbufferFace, pixel, 0).xy);
  screen.list[i] = EyePathStart(position.xyz, there ? 1.0 : 0.0, normal, 0.0, face, 0.0);
}
#endif
