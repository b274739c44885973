#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/scene.glsl"

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;

void main() {
  position = scenePosition(gl_VertexIndex);
  vec4 attributes = texelFetch(sceneAttributes, gl_VertexIndex);
  normal = octDecode(attributes.xy);
  uv = attributes.zw;
  gl_Position = view.worldToClip * vec4(position, 1.0);
}
