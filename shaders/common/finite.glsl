// Numbers that are none.
#ifndef FOVEA_FINITE_GLSL
#define FOVEA_FINITE_GLSL

// Neither infinite nor not a number; by its bits, as compilers may assume that comparisons never see either.
bool finite(vec4 x) { return all(notEqual(floatBitsToUint(x) & 0x7f800000u, uvec4(0x7f800000u))); }

#endif
