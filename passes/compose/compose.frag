#include "scene/compose.glsl"
