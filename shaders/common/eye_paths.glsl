// Reads the bundle `eye-paths`.
#ifndef FOVEA_EYE_PATHS_GLSL
#define FOVEA_EYE_PATHS_GLSL

#include "common/records/eye_paths.h"

const float kShining = 3.0;  // EyePathEnd::kind of a surface that shines

EyePathEnd loadEyePathEnd(samplerBuffer list, uint path) {
  int first = 3 * int(path);
  vec4 a = texelFetch(list, first), b = texelFetch(list, first + 1), c = texelFetch(list, first + 2);
  return EyePathEnd(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w);
}

float luminanceOf(vec3 colour) { return dot(colour, vec3(0.2126, 0.7152, 0.0722)); }

#endif
