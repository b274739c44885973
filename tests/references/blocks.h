// Blocks of pixels that share a sample, as a plain reference for shaders/screen/blocks.glsl.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "framework/base/random.h"

namespace fovea::passes {

// Code of a sample, as pass temporal-accumulation reads it; exact in half precision. Bits 0 to 3: width of the block
// in pixels, at most 8; 4 to 6 and 7 to 9: x and y in it of the sampled pixel; 10: that pixel shows no surface, so
// there is no sample.
constexpr uint32_t sampleCode(uint32_t side, glm::uvec2 pixel, bool found) {
  return side | pixel.x << 4 | pixel.y << 7 | (found ? 0u : 1u) << 10;
}

// The pixel whose turn it is in a block of side x side pixels, a power of two; consecutive turns lie far apart.
// block: its column and row. Vertically adjacent blocks use different columns and horizontally adjacent ones different
// rows, so that 2 x 2 blocks sample a strip one pixel wide in every frame.
inline glm::uvec2 samplePixel(uint32_t turn, uint32_t side, glm::uvec2 block) {
  turn += ((block.x & 1u) * 2u) ^ ((block.y & 1u) * 3u);
  glm::uvec2 p(0);
  for (uint32_t bit = side / 2; bit > 0; bit /= 2, turn /= 4) {
    p.x += (turn & 1u) * bit;
    p.y += ((turn ^ turn >> 1) & 1u) * bit;
  }
  return p;
}

// How far the first blocks of side x side pixels begin before the picture: the R2 sequence over the frames, in steps of
// two pixels. As a plain reference for shaders/screen/lattice.glsl.
inline glm::uvec2 latticeOffset(uint32_t frame, uint32_t side) {
  const glm::vec2 at(uniformFloat(frame * 3242174889u), uniformFloat(frame * 2447445414u));
  return 2u * glm::uvec2(at * float(side / 2));
}

// The first pixel, which may lie outside the picture, of the block that holds a pixel.
inline glm::ivec2 blockCorner(glm::ivec2 pixel, uint32_t side, uint32_t frame) {
  const glm::ivec2 offset(latticeOffset(frame, side));
  return (pixel + offset) / int(side) * int(side) - offset;
}

}  // namespace fovea::passes
