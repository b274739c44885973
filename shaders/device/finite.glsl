// A test for infinities and NaN.
#ifndef FOVEA_FINITE_GLSL
#define FOVEA_FINITE_GLSL

// True if no component is infinite or NaN. Tests the bits, as compilers may assume that comparisons
// never see such values.
bool finite(vec4 x) { return all(notEqual(floatBitsToUint(x) & 0x7f800000u, uvec4(0x7f800000u))); }

#endif
