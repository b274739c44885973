// For every pixel, the pixel of the previous frame that showed the same surface, if there is one.
//
// One of the four texels around the previous position is chosen at random with bilinear probabilities, so that
// sub-pixel motion is correct on average at the cost of one load.
#include "common/random.glsl"
#include "common/same_surface.glsl"
#include "common/motion.glsl"

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

// A whole pixel for a place between pixels: each of the four around it with its bilinear probability.
ivec2 oneOfFour(vec2 at, uint bits) {
  vec2 still = round(at);
  at = mix(at, still, lessThan(abs(at - still), vec2(kSamePlace)));
  return ivec2(floor(at + vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)))));
}

uint originOf(ivec2 p, vec4 position, vec3 normal, ivec2 size) {
  vec3 before = positionBefore(position.xyz, imageLoad(gbufferId, p).r);
  vec4 clip = view.previousWorldToClip * vec4(before, 1.0);
  if (!(clip.w > 0.0)) return kNone;
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * vec2(size) - 0.5;  // texel centres at whole numbers
  uint bits = randomStream(uint(p.x), frameIndex, kJitterStream, uint(p.y));
  ivec2 corner = ivec2(floor(at)), first = oneOfFour(at, bits) - corner;
  float tolerance = planeTolerance * position.w;
  // What is kept from frame to frame belongs to whole pixels. A jittered view sees even what stands still elsewhere in
  // its pixel; taking its history from there would let it wander. So the jitter is left out at first, and only at an
  // edge, where that pixel showed something else, are those around the exact place looked at.
  int jittered = int(view.jitterStep != vec2(0.0));
  ivec2 unjittered = oneOfFour(at - view.jitterStep, bits);
  for (int turn_ = 0; turn_ < 4 + jittered; ++turn_) {
    int i = turn_ - jittered;
    ivec2 q = i < 0 ? unjittered : corner + (first ^ ivec2(i & 1, i >> 1));
    ivec2 inside = clamp(q, ivec2(0), size - 1);
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
