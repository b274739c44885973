// Clears the maps that are about to be drawn or whose VPL has gone, and records what they are drawn with.
// One work group per slot. Defines: STATIC_MAPS 0/1: static geometry is drawn to a map of its own
// (compose.comp); HAS_STATE 0/1.
#include "vpls/paraboloid.glsl"
#include "vpls/vpl.glsl"
#include "shadow-atlas/step.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer ChosenBlock { uint list[]; } chosen;
layout(r32ui) uniform writeonly uimage2DArray atlas;
#if STATIC_MAPS
layout(r32ui) uniform writeonly uimage2DArray staticMaps;
#endif
#if HAS_STATE
layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) writeonly buffer DrawnBlock { DrawnMap maps[]; } drawn;
#endif

layout(push_constant) uniform Constants {
#if HAS_STATE
  vec4 movers[kMovers];
  uint poses[kMovers];
#endif
  uint slots;
};

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * kGroupsPerRow;
  if (slot >= slots) return;
  uint choice = chosen.list[slot];
#if HAS_STATE
  if (isDrawn(choice) && gl_LocalInvocationIndex == 0u) {
    Vpl v = vpls.list[slot];
    drawn.maps[slot].position = v.position;
    drawn.maps[slot].normal = v.normal;
    for (uint i = 0u; i < kMovers; ++i) {
      drawn.maps[slot].movers[i] = movers[i];
      drawn.maps[slot].poses[i] = poses[i];
    }
  }
#endif
  if (choice != kSlotNew && choice != kSlotRefreshed && choice != kSlotEmptied) return;
  AtlasLayout layout_ = atlasLayout(imageSize(atlas));
  ivec3 corner = atlasTexel(slot, ivec2(0), layout_);
  for (int y = int(gl_LocalInvocationIndex) / 16; y < layout_.size; y += 4)
    for (int x = int(gl_LocalInvocationIndex) % 16; x < layout_.size; x += 16) {
#if STATIC_MAPS
      if (choice != kSlotEmptied)
        imageStore(staticMaps, corner + ivec3(x, y, 0), uvec4(kParaboloidEmpty));
      else
#endif
        imageStore(atlas, corner + ivec3(x, y, 0), uvec4(kParaboloidEmpty));
    }
}
