// Boxes around all that moves, in this frame and the last one: scene::MoverBoxes. Low > high: unused.
// Define: MOVER_BOXES, scene::MoverBoxes::kCount.
#ifndef FOVEA_MOVERS_GLSL
#define FOVEA_MOVERS_GLSL

const uint kMoverBoxes = uint(MOVER_BOXES);

#endif
