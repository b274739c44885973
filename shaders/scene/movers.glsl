// Boxes around everything that moves, in this frame and the previous one. A box whose low corner exceeds its high one
// is unused.
//
// Define: MOVER_BOXES, their number (scene::MoverBoxes::kCount).
#ifndef FOVEA_MOVERS_GLSL
#define FOVEA_MOVERS_GLSL

const uint kMoverBoxes = uint(MOVER_BOXES);

#endif
