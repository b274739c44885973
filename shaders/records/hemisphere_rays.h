// Six fixed directions over a hemisphere.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// In the frame orthonormalFrame(normal) of vpls/paraboloid.glsl: the normal and five directions 60 degrees from it.
// These are the axes of six cones with an opening angle of 60 degrees that cover the hemisphere (Crassin et al.,
// "Interactive Indirect Illumination Using Voxel Cone Tracing", 2011). Their mean points along the normal. Weighted
// by their cosines, the normal stands for 1 / 3.5 of the cosine-weighted hemisphere, which is a cap of 32 degrees,
// and the others for the rest, whose median is at 53 degrees. The ring is turned by 10.8 degrees so that no ray runs
// along the planes of the grid when the normal is an axis. Such rays would meet cell edges everywhere, and rounding
// would decide the cell.
SHARED_CONSTANT int kHemisphereRays = 6;
SHARED_CONSTANT vec3 kHemisphereRay[kHemisphereRays] = {{0.0f, 0.0f, 1.0f},
                                                        {0.850685713f, 0.162276979f, 0.5f},
                                                        {0.108541764f, 0.859196535f, 0.5f},
                                                        {-0.783603213f, 0.368735683f, 0.5f},
                                                        {-0.592835184f, -0.631305350f, 0.5f},
                                                        {0.417210920f, -0.758903846f, 0.5f}};
SHARED_CONSTANT float kHemisphereCosines = 3.5f;  // sum of the cosines

SHARED_END
