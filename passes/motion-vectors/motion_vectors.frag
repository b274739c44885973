// For every pixel, the pixel of the previous frame that showed the same surface, if there is one.
//
// One of the four texels around the previous position is chosen at random with bilinear probabilities, so that
// sub-pixel motion is correct on average at the cost of one load.
#include "materials/gloss.glsl"
#include "screen/history.glsl"
#include "screen/same_surface.glsl"
#include "screen/gbuffer.glsl"
#include "scene/motion.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(r32ui) uniform readonly uimage2D gbufferId;
layout(r32ui) uniform readonly uimage2D gbufferTriangle;
SURFACES(previous, previousAt)
layout(rgba16f) uniform readonly image2D previousNormal;
layout(location = 0) out uint origin;

layout(push_constant) uniform Constants {
  uint frameIndex;
  float planeTolerance;  // relative to the distance from the eye
  float leastCos;
};

const uint kJitterStream = 0x74656d70u;
const int kVeiledReach = 2;  // pixels around a place where surfaces let light through

// Place number k of the ring of 8 * radius pixels around a pixel.
ivec2 onRing(int k, int radius) {
  int side = k / (2 * radius), along = k % (2 * radius) - radius;
  ivec2 d = (side & 1) == 0 ? ivec2(along, -radius) : ivec2(radius, along);
  return side < 2 ? d : -d;
}

// veiled: whether the pixel may show another surface in each frame, as one of them lets light through.
uint originOf(ivec2 p, vec4 position, vec3 normal, bool veiled, ivec2 size) {
  Motion motion = motionOf(position.xyz, imageLoad(gbufferId, p).r, imageLoad(gbufferTriangle, p).r);
  vec3 before = pointBefore(motion, position.xyz);
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
    if (q == inside && sameSurface(before, normal, normal, previousAt(inside),
                                   imageLoad(previousNormal, inside).xyz, tolerance, leastCos))
      return packPixel(q);
  }
  // One of those around it showed the surface, as neighbours show all that is there by its share.
  for (int radius = 1; radius <= (veiled ? kVeiledReach : 0); ++radius)
    for (int i = 0; i < 8 * radius; ++i) {
      ivec2 q = unjittered + onRing(int((uint(i) + (bits >> 8)) % uint(8 * radius)), radius);
      ivec2 inside = clamp(q, ivec2(0), size - 1);
      if (q == inside && sameSurface(before, normal, normal, previousAt(inside),
                                     imageLoad(previousNormal, inside).xyz, tolerance, leastCos))
        return packPixel(q);
    }
  return kNone;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 position = surfaceAt(p);
  vec4 normal = imageLoad(gbufferNormal, p);
  origin = position.w > 0.0 ? originOf(p, position, normal.xyz, isVeiled(normal.a), imageSize(gbufferDistance)) : kNone;
}
