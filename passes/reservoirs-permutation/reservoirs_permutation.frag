// Lets the pixels of each block of 4 x 4 of the previous frame change places, all blocks in the same way; the blocks
// lie elsewhere in each frame (Wyman and Panteleev, "Rearchitecting Spatiotemporal Resampling for Production", HPG
// 2021). Define: PERMUTE 0/1.
#include "screen/history.glsl"
#include "screen/same_surface.glsl"
#include "screen/gbuffer.glsl"

SURFACES(previous, previousAt)
layout(rgba16f) uniform readonly image2D previousNormal;
layout(r32ui) uniform readonly uimage2D origin;
layout(location = 0) out uint sources;

layout(push_constant) uniform Constants {
  uint frameIndex;
  uint seed;
  float planeTolerance;  // relative to the distance from the eye
  float leastCosine;
};

const uint kPermutationStream = 0x72657065u;

void main() {
  sources = imageLoad(origin, ivec2(gl_FragCoord.xy)).r;
  if (PERMUTE == 0 || sources == kNone) return;
  uint bits = randomStream(seed, frameIndex, kPermutationStream, 0u);
  ivec2 q = ivec2(sources & 0xffffu, sources >> 16), offset = ivec2(bits >> 8, bits >> 16) & 3;
  ivec2 other = ((q + offset) ^ 3) - offset, inside = clamp(other, ivec2(0), imageSize(previousDistance) - 1);
  vec4 position = previousAt(q);
  vec3 normal = imageLoad(previousNormal, q).xyz;
  if (other == inside && sameSurface(position.xyz, normal, normal, previousAt(inside),
                                     imageLoad(previousNormal, inside).xyz, planeTolerance * position.w, leastCosine))
    sources = packPixel(other);
}
