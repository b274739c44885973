// Where the blocks lie whose pixels share a sample. Those wider than 2 pixels lie elsewhere in each frame, so that the mean
// over frames is a smooth picture and shows no lattice.
#ifndef FOVEA_LATTICE_GLSL
#define FOVEA_LATTICE_GLSL

#include "sampling/random.glsl"

// How far, in pixels, the first blocks of this width begin before the picture: even numbers below `side`, which is a
// power of two.
uvec2 latticeOffset(uint frameIndex, uint side) {
  return 2u * uvec2(r2Sequence(uvec2(0u), frameIndex) * float(side / 2u));
}

#endif
