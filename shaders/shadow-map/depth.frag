#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Holes of alpha-masked materials let light through.
#include "common/scene.glsl"

layout(location = 0) in vec2 uv;

layout(push_constant) uniform Constants { uint firstTriangle; };

void main() {
  uint material = texelFetch(sceneTriangles, int(firstTriangle) + gl_PrimitiveID).w & 0xffffu;
  if (!alphaTest(material, uv)) discard;
}
