// Reading the bundle `eye-paths`.
#ifndef FOVEA_EYE_PATHS_GLSL
#define FOVEA_EYE_PATHS_GLSL

#include "records/eye_paths.h"

// Values of EyePathEnd::kind: without direct light; of an emissive surface; of a surface that others of that kind
// light.
const float kUnlit = 1.0, kShining = 3.0, kGlowing = 4.0;

// End of a path by its number. list: the member `ends` of the bundle.
EyePathEnd loadEyePathEnd(samplerBuffer list, uint path) {
  int first = 3 * int(path);
  vec4 a = texelFetch(list, first), b = texelFetch(list, first + 1), c = texelFetch(list, first + 2);
  return EyePathEnd(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w);
}

// Luminance of linear sRGB (Rec. 709).
float luminanceOf(vec3 colour) { return dot(colour, vec3(0.2126, 0.7152, 0.0722)); }

#endif
