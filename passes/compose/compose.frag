#include "common/compose.glsl"
