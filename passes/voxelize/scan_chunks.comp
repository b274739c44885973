// Third step of the prefix sum over chunks: replaces each triangle's number of chunks by that of
// all triangles before it.
#include "voxelize/scan.glsl"

layout(local_size_x = 256) in;

layout(std430) buffer ChunksBlock { uint list[]; } chunks;
layout(std430) readonly buffer BlocksBlock { uint sums[]; } blocks;

layout(push_constant) uniform Constants { uint count; };

void main() {
  uint block = groupIndex(), i = block * kScanBlock + gl_LocalInvocationIndex;
  uint total, before = exclusiveSum(i < count ? chunks.list[i] : 0u, total);
  if (i < count) chunks.list[i] = blocks.sums[block] + before;
}
