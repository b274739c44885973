// The rays of the view's pixels.
#ifndef FOVEA_PIXEL_RAY_GLSL
#define FOVEA_PIXEL_RAY_GLSL

#include "scene/scene.glsl"

// Direction of the ray from view.eye through a point of the picture, in pixels, or through the centre of a pixel; in
// world space, not normalised. Also for off-axis projections.
vec3 pixelRay(vec2 at) {
  vec2 ndc = 2.0 * at * view.inverseSize - 1.0;
  vec2 d = (ndc + vec2(view.viewToClip[2])) / vec2(view.viewToClip[0][0], view.viewToClip[1][1]);
  return vec3(d, -1.0) * mat3(view.worldToView);
}
vec3 pixelRay(ivec2 pixel) { return pixelRay(vec2(pixel) + 0.5); }

#endif
