#include "common/scene.glsl"

#if TESTED
layout(location = 0) out vec2 uv;
#endif

void main() {
  gl_Position = view.worldToClip * vec4(scenePosition(gl_VertexIndex), 1.0);
#if TESTED
  uv = sceneUv(gl_VertexIndex);
#endif
}
