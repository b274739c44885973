// The number of blocks to shade before each tile, and the indirect dispatch over all of them. One work group, as
// tiles are few. Defines: INTERLEAVE.

const uint kThreads = 256u;
const uint kBlocksPerGroup = 256u;  // blocks per work group of the shading, see deferred/shade.comp

layout(local_size_x = 256) in;

layout(std430) buffer TileBlocks { uint count[]; } tileBlocks;
layout(std430) writeonly buffer ShadeDispatch { uvec4 groups; } shadeDispatch;

layout(push_constant) uniform Constants {
  uint tiles;
};

shared uint before[kThreads];

void main() {
  uint thread = gl_LocalInvocationIndex, each = (tiles + kThreads - 1u) / kThreads;
  uint first = min(thread * each, tiles), end = min(first + each, tiles);
  uint sum = 0u;
  for (uint i = first; i < end; ++i) sum += tileBlocks.count[i];
  before[thread] = sum;
  barrier();
  if (thread == 0u) {
    uint total = 0u;
    for (uint i = 0u; i < kThreads; ++i) {
      uint here = before[i];
      before[i] = total;
      total += here;
    }
    shadeDispatch.groups = uvec4((total + kBlocksPerGroup - 1u) / kBlocksPerGroup, INTERLEAVE * INTERLEAVE, 1u, total);
  }
  barrier();
  uint total = before[thread];
  for (uint i = first; i < end; ++i) {
    uint here = tileBlocks.count[i];
    tileBlocks.count[i] = total;
    total += here;
  }
}
