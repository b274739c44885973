// Pixels of the previous frame, by which what is kept follows the surfaces.
#ifndef FOVEA_HISTORY_GLSL
#define FOVEA_HISTORY_GLSL

#include "sampling/random.glsl"

CONSTANT uint kNone = 0xffffffffu;  // in place of a pixel: none
CONSTANT float kSamePlace = 1e-3;   // pixels: does not move

// A pixel as one word, x | y << 16.
uint packPixel(ivec2 p) { return uint(p.x) | uint(p.y) << 16; }
ivec2 unpackPixel(uint word) { return ivec2(word & 0xffffu, word >> 16); }

// One of the four pixels around a place, each with its bilinear probability. at: pixels, whose centres are whole
// numbers here; bits: random, all 32 of them.
ivec2 oneOfFour(vec2 at, uint bits) {
  vec2 still = round(at);
  at = mix(at, still, lessThan(abs(at - still), vec2(kSamePlace)));
  return ivec2(floor(at + vec2(uniformFloat(bits), uniformFloat(hashPcg(bits)))));
}

#endif
