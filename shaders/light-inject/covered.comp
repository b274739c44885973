#version 460
#extension GL_GOOGLE_include_directive : require
// Which part of each shadow map all that moves may cover: xy: least, zw: largest position in [-1, 1]; and an empty list.
// Define: SHADOWED 0/1.
#include "common/scene.glsl"
#include "common/shadow.glsl"

layout(local_size_x = 64) in;

layout(set = 0, std430) writeonly buffer Work { uint x, y, z, count; } work;
#if SHADOWED
layout(set = 0, std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;
layout(set = 0, std430) writeonly buffer Covered { vec4 layers[]; } covered;

layout(push_constant) uniform Constants {
  vec4 moversLow, moversHigh;  // box around all that moves, in this frame and the last one
  uint layerCount;
};
#endif

void main() {
  uint layer = gl_GlobalInvocationID.x;
  if (layer == 0u) {
    work.x = 0u;
    work.y = work.z = 1u;
    work.count = 0u;
  }
#if SHADOWED
  if (layer >= layerCount) return;
  vec2 low = vec2(1e30), high = vec2(-1e30);
  float nearest = 1e30;
  for (int i = 0; i < 8; ++i) {
    vec3 corner = mix(moversLow.xyz, moversHigh.xyz, bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0));
    vec4 clip = mapsViews.view[layer].worldToClip * vec4(corner, 1.0);
    vec2 at = clip.xy / max(clip.w, 1e-6);
    low = min(low, at);
    high = max(high, at);
    nearest = min(nearest, clip.w);
  }
  // Reaches behind the light's plane: anywhere.
  covered.layers[layer] = nearest > 1e-5 ? vec4(low, high) : vec4(-1e30, -1e30, 1e30, 1e30);
#endif
}
