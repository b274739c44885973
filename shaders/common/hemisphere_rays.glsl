// Six fixed directions over a hemisphere, the same as in framework/shader_twins/hemisphere_rays.h.
#ifndef FOVEA_HEMISPHERE_RAYS_GLSL
#define FOVEA_HEMISPHERE_RAYS_GLSL

// In the frame orthonormalFrame(normal) of common/paraboloid.glsl: the normal and five directions 60 degrees from it.
// These are the axes of six cones with an opening angle of 60 degrees that cover the hemisphere (Crassin et al.,
// "Interactive Indirect Illumination Using Voxel Cone Tracing", 2011). Their mean points along the normal. Weighted
// by their cosines, the normal stands for 1 / 3.5 of the cosine-weighted hemisphere, which is a cap of 32 degrees,
// and the others for the rest, whose median is at 53 degrees. The ring is turned by 10.8 degrees so that no ray runs
// along the planes of the grid when the normal is an axis. Such rays would meet cell edges everywhere, and rounding
// would decide the cell.
const int kHemisphereRays = 6;
const vec3 kHemisphereRay[kHemisphereRays] = vec3[](
    vec3(0.0, 0.0, 1.0), vec3(0.850685713, 0.162276979, 0.5), vec3(0.108541764, 0.859196535, 0.5),
    vec3(-0.783603213, 0.368735683, 0.5), vec3(-0.592835184, -0.631305350, 0.5), vec3(0.417210920, -0.758903846, 0.5));
const float kHemisphereCosines = 3.5;  // sum of the cosines

#endif
