// For every pixel, the place where the other eye sees its surface. The point of the pixel is projected into the other
// picture. Of the pixels around it, those count that show the same object and material near the tangent plane of the
// pixel, with similar normals.
#include "screen/same_surface.glsl"
#include "screen/taps.glsl"
#include "scene/scene.glsl"
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rg16_snorm) uniform readonly image2D gbufferFace;
layout(r32ui) uniform readonly uimage2D gbufferId;
SURFACES(other, otherAt)
layout(rgba16f) uniform readonly image2D otherNormal;
layout(r32ui) uniform readonly uimage2D otherId;
layout(location = 0) out vec4 correspondence;

layout(push_constant) uniform Constants {
  float planeTolerance;  // relative to the distance from the eye
  float leastCosine;
  float leastWeight;
};

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), size = imageSize(otherDistance);
  vec4 position = surfaceAt(p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz, face = octDecode(imageLoad(gbufferFace, p).xy);
  correspondence = vec4(0.0);
  if (position.w <= 0.0) return;
  Taps taps = tapsAround(view.worldToClip, position.xyz, size);
  uint shown = 0u;
  float weight = 0.0;
  for (int i = 0; i < taps.count; ++i) {
    ivec2 q = tapPixel(taps, i), inside = clamp(q, ivec2(0), size - 1);
    bool same = q == inside && imageLoad(otherId, inside).r == imageLoad(gbufferId, p).r &&
                sameSurface(position.xyz, face, normal, otherAt(inside), imageLoad(otherNormal, inside).xyz,
                            planeTolerance * position.w, leastCosine);
    if (!same) continue;
    shown |= 1u << uint(i);
    weight += tapWeight(taps, i);
  }
  if (weight >= leastWeight) correspondence = vec4(vec2(taps.first) + taps.between + 0.5, float(shown), weight);
}
