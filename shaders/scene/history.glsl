// Pixels of the previous frame.
#ifndef FOVEA_HISTORY_GLSL
#define FOVEA_HISTORY_GLSL

#include "sampling/random.glsl"

CONSTANT uint kNone = 0xffffffffu;  // in place of a pixel: none
CONSTANT float kSamePlace = 1e-3;   // pixels: does not move

uint packPixel(ivec2 p) { return uint(p.x) | uint(p.y) << 16; }

// A whole pixel for a place between pixels, whose centres are whole numbers: each of the four around it with its
// bilinear probability.
ivec2 oneOfFour(vec2 at, uint bits) {
  vec2 still = round(at);
  at = mix(at, still, lessThan(abs(at - still), vec2(kSamePlace)));
  return ivec2(floor(at + vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)))));
}

#endif
