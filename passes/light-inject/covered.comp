// The part of each shadow map that moving objects may cover, one for each box around some of them, as positions in
// [-1, 1] (xy: least, zw: largest). Also empties the list. Defines: SHADOWED 0/1; MOVER_BOXES.
#include "scene/scene.glsl"
#include "voxels/voxel_trace.glsl"
#include "light-inject/patch.glsl"
#include "vpls/shadow.glsl"
#include "scene/movers.glsl"

layout(local_size_x = 64) in;

layout(std140) uniform VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
layout(std430) writeonly buffer Work { uint x, y, z, count; uint selectX, selectY, selectZ, unused; } work;
#if SHADOWED
layout(std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;
layout(std430) writeonly buffer Covered { vec4 parts[]; } covered;

layout(push_constant) uniform Constants {
  vec4 movers[2u * kMoverBoxes];
  uint layerCount;
};

const vec4 kNothing = vec4(1e30, 1e30, -1e30, -1e30);
const float kFront = 1e-4;  // m; maps show nothing nearer
const float kOutside = 1.1;  // the border is 1, with a margin of some texels for rounding by the rasteriser

void extend(vec4 clip, inout vec2 low, inout vec2 high) {
  vec2 at = clip.xy / max(clip.w, 0.5 * kFront);
  low = min(low, at);
  high = max(high, at);
}
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
    covered.parts[part] = kNothing;
    return;
  }
  vec4 corners[8];
  for (int i = 0; i < 8; ++i)
    corners[i] = mapsViews.view[layer].worldToClip *
                 vec4(mix(boxLow, boxHigh, bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0)), 1.0);
  // Bounds of the part in front of the light, whose corners are the box's own and the points where its edges cross
  // the plane; empty if everything lies behind.
  vec2 low = vec2(1e30), high = vec2(-1e30);
  for (int i = 0; i < 8; ++i) {
    if (corners[i].w > kFront) extend(corners[i], low, high);
    for (int axis = 1; axis < 8; axis *= 2) {
      vec4 from = corners[i], to = corners[i ^ axis];
      if (from.w > kFront && to.w <= kFront) extend(mix(from, to, (from.w - kFront) / (from.w - to.w)), low, high);
    }
  }
  // Tests whether the bounds lie outside the map.
  bool outside = any(greaterThan(low, vec2(kOutside))) || any(lessThan(high, vec2(-kOutside)));
  covered.parts[part] = outside ? kNothing : vec4(low, high);
#endif
}
