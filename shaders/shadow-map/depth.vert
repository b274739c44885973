#extension GL_ARB_shader_viewport_layer_array : require
// One instance per layer.
#include "common/scene.glsl"
#include "common/shadow.glsl"

layout(std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;

#if TESTED
layout(location = 0) out vec2 uv;
#endif

void main() {
  gl_Layer = gl_InstanceIndex;
  gl_Position = mapsViews.view[gl_InstanceIndex].worldToClip * vec4(scenePosition(gl_VertexIndex), 1.0);
#if TESTED
  uv = sceneUv(gl_VertexIndex);
#endif
}
