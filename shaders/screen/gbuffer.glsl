// Where the surfaces of a G-buffer lie.
#ifndef FOVEA_GBUFFER_GLSL
#define FOVEA_GBUFFER_GLSL

#include "device/language.glsl"
#include "records/scene.h"

// The direction of the ray through a point of the picture, which is given in pixels. The direction is in world space
// and not normalised.
vec3 pixelRay(PixelRays rays, vec2 at) { return rays.corner + at.x * rays.right + at.y * rays.down; }

// The surface at a pixel, from the members `camera` and `distance` of the G-buffer. xyz: position, world space, m; w:
// the distance from the eye, m, 0 in the background.
vec4 surfaceAt(PixelRays camera, ivec2 pixel, float distance_) {
  return vec4(camera.eye + distance_ * normalize(pixelRay(camera, vec2(pixel) + 0.5)), distance_);
}

// Declares these members of a port, and a function that gives its surfaces: SURFACES(gbuffer, surfaceAt) makes
// vec4 surfaceAt(ivec2 pixel).
#define SURFACES(port, name)                                                         \
  IMAGE(r32f, readonly, image2D, port##Distance);                                    \
  VALUE(readonly, PixelRays, port##Camera);                                          \
  vec4 name(ivec2 pixel) {                                                           \
    return surfaceAt(port##Camera.value, pixel, imageLoad(port##Distance, pixel).r); \
  }

#endif
