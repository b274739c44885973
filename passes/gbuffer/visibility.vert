#include "scene/drawn_vertex.glsl"
#include "scene/scene.glsl"

#if TESTED
layout(location = 0) out vec2 uv;
layout(location = 3) out float alpha;  // of the vertex colour
#if PASSAGE
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 toEye;
#endif
#endif

void main() {
  uint vertex = drawnVertex();
  vec3 position = scenePosition(vertex);
  gl_Position = view.worldToClip * vec4(position, 1.0);
#if TESTED
  uv = sceneUv(vertex);
  alpha = sceneAlpha(vertex);
#if PASSAGE
  normal = sceneNormal(vertex);
  toEye = view.eye - position;
#endif
#endif
}
