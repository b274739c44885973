#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Holes of alpha-masked materials let light through.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;

void main() {
  if (!alphaTest(materialOf(sceneTriangle(uint(gl_PrimitiveID))), uv)) discard;
}
