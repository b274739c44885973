// Third step of the prefix sum over marked cells: gives each its voxel, in linear order. A voxel of a dynamic object
// remembers the voxel that it hides.
#include "scene/scene.glsl"
#include "voxels/voxel.glsl"
#include "voxelize/scan.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer MarksBlock { uint words[]; } marks;
layout(std430) readonly buffer BlocksBlock { uint sums[]; } blocks;
layout(std430) readonly buffer StateBlock { State value; } state;
layout(std430) writeonly buffer CellsBlock { uvec2 list[]; } cells;
layout(r32ui) uniform uimage3D voxelsIndex;
layout(r32ui) uniform uimage3D voxelsOccupied;

layout(push_constant) uniform Constants {
  uint count;  // words
  uint blockCount;
  uint resolution;
  uint phase;
};

void main() {
  uint block = groupIndex(), i = block * kScanBlock + gl_LocalInvocationIndex;
  if (block >= blockCount) return;
  uint last = state.value.phases[phase].voxels + state.value.phases[phase].overflow;
  if (blocks.sums[block] == (block + 1u < blockCount ? blocks.sums[block + 1u] : last)) return;  // nothing marked
  uint bits = i < count ? marks.words[i] : 0u, total;
  uint rank = exclusiveSum(uint(bitCount(bits)), total) + blocks.sums[block];
  uint room = state.value.phases[phase].voxels, first = state.value.phases[phase].first;
  while (bits != 0u && rank < room) {
    uint linear = i * 32u + uint(findLSB(bits));
    ivec3 cell = ivec3(linear % resolution, linear / resolution % resolution, linear / (resolution * resolution));
    cells.list[first + rank] = uvec2(linear, imageLoad(voxelsIndex, cell).r);
    imageStore(voxelsIndex, cell, uvec4(first + rank + 1u));
    imageAtomicOr(voxelsOccupied, occupiedBrick(cell), occupiedBit(cell));
    bits &= bits - 1u;
    ++rank;
  }
}
