// For every pixel, the pixel of the previous frame that showed the same surface, if there is one.
//
// One of the four texels around the previous position is chosen at random with bilinear probabilities, so that
// sub-pixel motion is correct on average at the cost of one load.
#include "common/random.glsl"
#include "common/same_surface.glsl"
#include "common/scene.glsl"

layout(rgba32f) uniform readonly image2D gbufferPosition;
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(r32ui) uniform readonly uimage2D gbufferId;
layout(rgba32f) uniform readonly image2D previousPosition;
layout(rgba16f) uniform readonly image2D previousNormal;
layout(location = 0) out uint origin;

layout(push_constant) uniform Constants {
  uint frameIndex;
  float planeTolerance;  // relative to the distance from the eye
  float leastCos;
};

const uint kNone = 0xffffffffu;
const uint kJitterStream = 0x74656d70u;
const float kSamePlace = 1e-3;  // pixels: does not move

// Position of the surface in the previous frame; for one that deforms, its position now.
vec3 positionBefore(vec3 position, uint id) {
  uint object = id >> 16;
  for (int turn_ = 0; turn_ < int(object != 0u); ++turn_)  // a loop, as a CPU device runs unused branches
    if (!objectDeforms(object)) position = previousObjectTransform(object) * vec4(toObject(object, position), 1.0);
  return position;
}

uint originOf(ivec2 p, vec4 position, vec3 normal, ivec2 size) {
  vec3 before = positionBefore(position.xyz, imageLoad(gbufferId, p).r);
  vec4 clip = view.previousWorldToClip * vec4(before, 1.0);
  if (!(clip.w > 0.0)) return kNone;
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * vec2(size) - 0.5;  // texel centres at whole numbers
  uint bits = randomStream(uint(p.x), frameIndex, kJitterStream, uint(p.y));
  vec2 still = round(at), corner = floor(at);
  at = mix(at, still, lessThan(abs(at - still), vec2(kSamePlace)));
  ivec2 first = ivec2(floor(at + vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)))) - corner);
  float tolerance = planeTolerance * position.w;
  for (int i = 0; i < 4; ++i) {
    ivec2 q = ivec2(corner) + (first ^ ivec2(i & 1, i >> 1)), inside = clamp(q, ivec2(0), size - 1);
    if (q == inside && sameSurface(before, normal, normal, imageLoad(previousPosition, inside),
                                   imageLoad(previousNormal, inside).xyz, tolerance, leastCos))
      return uint(q.x) | uint(q.y) << 16;
  }
  return kNone;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 position = imageLoad(gbufferPosition, p);
  origin = position.w > 0.0 ? originOf(p, position, imageLoad(gbufferNormal, p).xyz, imageSize(gbufferPosition)) : kNone;
}
