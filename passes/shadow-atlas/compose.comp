// Initialises the maps that are drawn in this frame from those of static geometry. One work group per slot.
#include "vpls/paraboloid.glsl"
#include "shadow-atlas/step.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer ChosenBlock { uint list[]; } chosen;
layout(r32ui) uniform writeonly uimage2DArray atlas;
layout(r32ui) uniform readonly uimage2DArray staticMaps;

layout(push_constant) uniform Constants { uint slots; };

void main() {
  uint slot = gl_WorkGroupID.x + gl_WorkGroupID.y * kGroupsPerRow;
  if (slot >= slots || !isDrawn(chosen.list[slot])) return;
  AtlasLayout layout_ = atlasLayout(imageSize(atlas));
  ivec3 corner = atlasTexel(slot, ivec2(0), layout_);
  for (int y = int(gl_LocalInvocationIndex) / 16; y < layout_.size; y += 4)
    for (int x = int(gl_LocalInvocationIndex) % 16; x < layout_.size; x += 16) {
      ivec3 texel = corner + ivec3(x, y, 0);
      imageStore(atlas, texel, uvec4(imageLoad(staticMaps, texel).r));
    }
}
