// Blocks of pixels that share a sample in pass near-field: tiles of `spacing` x `spacing` pixels, and texels of 2 x 2
// pixels in them.
#ifndef FOVEA_BLOCKS_GLSL
#define FOVEA_BLOCKS_GLSL

#include "scene/scene.glsl"
#include "screen/lattice.glsl"

// Size of the view in pixels, in texels, and in tiles at most. Tiles may extend beyond the view on all sides, and the
// last row and column may lie outside of it.
uvec2 viewSize() { return uvec2(view.size); }
uvec2 texelCount() { return (viewSize() + 1u) / 2u; }
uvec2 tileCount(uint spacing) { return (viewSize() + 2u * spacing - 3u) / spacing; }

// A tile by its number, row by row; and its first pixel in a frame.
uvec2 tileOf(uint number, uint spacing) { return uvec2(number % tileCount(spacing).x, number / tileCount(spacing).x); }
ivec2 tileCorner(uvec2 tile, uint spacing, uint frameIndex) {
  return ivec2(spacing * tile) - ivec2(latticeOffset(frameIndex, spacing));
}

// The number of the tile that a pixel is in; and the place in a list of texels of the first texel inside the view of a
// tile with that corner.
uint tileNumber(uvec2 pixel, uint spacing, uint frameIndex) {
  uvec2 tile = (pixel + latticeOffset(frameIndex, spacing)) / spacing;
  return tile.y * tileCount(spacing).x + tile.x;
}
uint firstTexel(ivec2 corner) {
  uvec2 texel = uvec2(max(corner, ivec2(0))) / 2u;
  return texel.y * texelCount().x + texel.x;
}

// The pixel whose turn it is in a block, relative to its corner. turn_: grows by 1 from sample to sample, and after
// side^2 of them all pixels have had a turn; side: pixels per side of the block, a power of two; block: its number in x
// and y, by which neighbours take their turns in different orders.
uvec2 samplePixel(uint turn_, uint side, uvec2 block) {
  turn_ += (block.x & 1u) * 2u ^ (block.y & 1u) * 3u;
  uvec2 p = uvec2(0u);
  for (uint bit = side / 2u; bit > 0u; bit /= 2u, turn_ /= 4u) {
    p.x += (turn_ & 1u) * bit;
    p.y += ((turn_ ^ turn_ >> 1) & 1u) * bit;
  }
  return p;
}

#endif
