// The rays of the view's pixels.
#ifndef FOVEA_PIXEL_RAY_GLSL
#define FOVEA_PIXEL_RAY_GLSL

#include "common/scene.glsl"

// Direction of the ray through the centre of a pixel, not normalised; also for off-axis projections.
vec3 pixelRay(ivec2 p) {
  vec2 ndc = (2.0 * vec2(p) + 1.0) * view.inverseSize - 1.0;
  vec2 d = (ndc + view.viewToClip[2].xy) / vec2(view.viewToClip[0][0], view.viewToClip[1][1]);
  return vec3(d, -1.0) * mat3(view.worldToView);
}

#endif
