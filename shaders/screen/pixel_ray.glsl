// The rays of the view's pixels.
#ifndef FOVEA_PIXEL_RAY_GLSL
#define FOVEA_PIXEL_RAY_GLSL

#include "scene/scene.glsl"
#include "screen/gbuffer.glsl"

// Direction of the ray from view.eye through a point of the picture, in pixels, or through the centre of a pixel; in
// world space, not normalised.
vec3 pixelRay(vec2 at) { return pixelRay(view.rays, at); }
vec3 pixelRay(ivec2 pixel) { return pixelRay(vec2(pixel) + 0.5); }

#endif
