// Boxes around everything that moves, in this frame and the last one (scene::MoverBoxes). A box with low > high is
// unused. Define: MOVER_BOXES, scene::MoverBoxes::kCount.
#ifndef FOVEA_MOVERS_GLSL
#define FOVEA_MOVERS_GLSL

const uint kMoverBoxes = uint(MOVER_BOXES);

#endif
