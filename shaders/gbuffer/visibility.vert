#include "common/scene.glsl"

#if TESTED
layout(location = 0) out vec2 uv;
#if PASSAGE
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 toEye;
#endif
#endif

void main() {
  vec3 position = scenePosition(gl_VertexIndex);
  gl_Position = view.worldToClip * vec4(position, 1.0);
#if TESTED
  uv = sceneUv(gl_VertexIndex);
#if PASSAGE
  normal = sceneNormal(gl_VertexIndex);
  toEye = view.eye - position;
#endif
#endif
}
