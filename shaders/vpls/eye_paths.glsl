// Reading the bundle `eye-paths`.
#ifndef FOVEA_EYE_PATHS_GLSL
#define FOVEA_EYE_PATHS_GLSL

#include "device/texels.glsl"
#include "records/eye_paths.h"

// Values of EyePathEnd::kind: without direct light; of an emissive surface; of a surface that others of that kind
// light.
const float kUnlit = 1.0, kShining = 3.0, kGlowing = 4.0;

// The end of a path by its number, a uint. list: the member `ends` of the bundle, declared as LARGE_TEXELS(vec4, list).
#define loadEyePathEnd(list, path) \
  eyePathEndOf(texelOf(list, 3 * int(path)), texelOf(list, 3 * int(path) + 1), texelOf(list, 3 * int(path) + 2))
// The same from its texels.
EyePathEnd eyePathEndOf(vec4 a, vec4 b, vec4 c) { return EyePathEnd(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w); }

// Luminance of linear sRGB (Rec. 709).
float luminanceOf(vec3 colour) { return dot(colour, vec3(0.2126, 0.7152, 0.0722)); }

#endif
