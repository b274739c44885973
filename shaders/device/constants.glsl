// Constants of mathematics.
#ifndef FOVEA_CONSTANTS_GLSL
#define FOVEA_CONSTANTS_GLSL

#include "device/language.glsl"

CONSTANT float kPi = 3.14159265358979;

#endif
