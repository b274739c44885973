// One instance per layer.
#include "scene/drawn_vertex.glsl"
#include "scene/scene.glsl"
#include "vpls/shadow.glsl"

layout(std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;

#if TESTED
layout(location = 0) out vec2 uv;
layout(location = 3) out float alpha;  // of the vertex colour
#endif

void main() {
  uint vertex = drawnVertex();
  gl_Position = mapsViews.view[drawnLayer()].worldToClip * vec4(scenePosition(vertex), 1.0);
#if TESTED
  uv = sceneUv(vertex);
  alpha = sceneAlpha(vertex);
#endif
}
