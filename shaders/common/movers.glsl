// Boxes around all that moves, in this frame and the last one: scene::MoverBoxes. Low > high: unused.
#ifndef FOVEA_MOVERS_GLSL
#define FOVEA_MOVERS_GLSL

const uint kMoverBoxes = 3u;

#endif
