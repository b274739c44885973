// The grid of samples, the pixels that are shaded. With SCALE 1 these are all pixels, with SCALE 2 one of each square
// of 2 x 2 pixels; their light is then kept in an image of half the width and height.
#ifndef FOVEA_DEFERRED_SAMPLES_GLSL
#define FOVEA_DEFERRED_SAMPLES_GLSL

#ifndef SCALE
#define SCALE 1
#endif

#if SCALE > 1
#define partial coarse
#define partialGloss coarseGloss
#endif

layout(rgba16f) uniform image2D partial;
#if GLOSS
layout(rgba16f) uniform image2D partialGloss;
#endif

// The pixel that a sample of the grid is shaded at. It takes all places of its square in turn, so that edges between
// surfaces do not fall into the gaps of a regular grid.
ivec2 samplePixel(ivec2 at, ivec2 size) {
#if SCALE > 1
  at = SCALE * at + ivec2(at.y & 1, at.x & 1);
#endif
  return min(at, size - 1);
}

#endif
