#include "screen/compose.glsl"
