#version 460
#extension GL_GOOGLE_include_directive : require
// Which parts of each shadow map may be covered by what moves, one for each box around some of it: xy: least, zw: largest
// position in [-1, 1]; and an empty list.
// Defines: SHADOWED 0/1; MOVER_BOXES.
#include "common/scene.glsl"
#include "common/voxel_trace.glsl"
#include "light-inject/patch.glsl"
#include "common/shadow.glsl"
#include "common/movers.glsl"

layout(local_size_x = 64) in;

layout(set = 0, std140) uniform VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
layout(set = 0, std430) writeonly buffer Work { uint x, y, z, count; uint selectX, selectY, selectZ, unused; } work;
#if SHADOWED
layout(set = 0, std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;
layout(set = 0, std430) writeonly buffer Covered { vec4 parts[]; } covered;

layout(push_constant) uniform Constants {
  vec4 movers[2u * kMoverBoxes];
  uint layerCount;
};
#endif

void main() {
  uint part = gl_GlobalInvocationID.x;
  if (part == 0u) {
    work.x = 0u;
    work.y = work.z = 1u;
    work.count = 0u;
    work.selectX = (2u * voxelsInfo.value.voxels + kSidesPerGroup - 1u) / kSidesPerGroup;
    work.selectY = work.selectZ = 1u;
  }
#if SHADOWED
  uint layer = part / kMoverBoxes, box = part % kMoverBoxes;
  if (layer >= layerCount) return;
  vec3 boxLow = movers[2u * box].xyz, boxHigh = movers[2u * box + 1u].xyz;
  if (boxLow.x > boxHigh.x) {
    covered.parts[part] = vec4(1e30, 1e30, -1e30, -1e30);
    return;
  }
  vec2 low = vec2(1e30), high = vec2(-1e30);
  float nearest = 1e30;
  for (int i = 0; i < 8; ++i) {
    vec3 corner = mix(boxLow, boxHigh, bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0));
    vec4 clip = mapsViews.view[layer].worldToClip * vec4(corner, 1.0);
    vec2 at = clip.xy / max(clip.w, 1e-6);
    low = min(low, at);
    high = max(high, at);
    nearest = min(nearest, clip.w);
  }
  // Reaches behind the light's plane: anywhere.
  covered.parts[part] = nearest > 1e-5 ? vec4(low, high) : vec4(-1e30, -1e30, 1e30, 1e30);
#endif
}
