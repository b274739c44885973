// The list of blocks to shade: tile after tile, row after row in each tile. One tile per invocation. Defines:
// INTERLEAVE.

#include "reproject/records.h"

layout(local_size_x = 64) in;

layout(r8) uniform readonly image2D shadeMask;
layout(std430) readonly buffer TileBlocks { uint count[]; } tileBlocks;
layout(std430) writeonly buffer ShadeBlocks { uint list[]; } shadeBlocks;

layout(push_constant) uniform Constants {
  uint tiles;
};

void main() {
  uint tile = gl_GlobalInvocationID.x;
  if (tile >= tiles) return;
  uvec2 size = uvec2(imageSize(shadeMask));
  const uint kWide = uint(kTile);
  uint columns = (size.x + kWide - 1u) / kWide, next = tileBlocks.count[tile];
  uvec2 first = uvec2(tile % columns, tile / columns) * kWide, end = min(first + kWide, size);
  for (uint y = first.y; y < end.y; y += INTERLEAVE)
    for (uint x = first.x; x < end.x; x += INTERLEAVE)
      if (imageLoad(shadeMask, ivec2(x, y)).r > 0.5) shadeBlocks.list[next++] = x / INTERLEAVE | y / INTERLEAVE << 16u;
}
