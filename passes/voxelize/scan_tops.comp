// Second step of a prefix sum, one work group: the sums before each block. The total sizes the dispatches that
// follow.
#include "scene/scene.glsl"
#include "voxels/voxel.glsl"
#include "voxelize/scan.glsl"

layout(local_size_x = 256) in;

layout(std430) buffer BlocksBlock { uint sums[]; } blocks;
layout(std430) buffer StateBlock { State value; } state;
#if MARKS
layout(std430) buffer VoxelsInfoBlock { VoxelInfo value; } voxelsInfo;
#endif

layout(push_constant) uniform Constants {
  uint count;  // blocks
#if MARKS
  uint resolution;
  uint phase;
  uint room;  // room in the list, for both phases
#endif
};

void main() {
  uint before = 0u;
  for (uint base = 0u; base < count; base += 256u) {
    uint i = base + gl_LocalInvocationIndex, total;
    uint sum = exclusiveSum(i < count ? blocks.sums[i] : 0u, total);
    if (i < count) blocks.sums[i] = before + sum;
    before += total;
  }
  if (gl_LocalInvocationIndex != 0u) return;
#if MARKS
  uint first = phase == 0u ? 0u : state.value.phases[0].voxels;
  uint voxels = min(before, room - first), overflow = before - voxels;
  state.value.phases[phase] = Phase(uint[3]((2u * voxels + 63u) / 64u, 1u, 1u), voxels, first, overflow, 0u, 0u);
  uint earlier = phase == 0u ? 0u : state.value.phases[0].overflow;
  voxelsInfo.value = VoxelInfo(first + voxels, phase == 0u ? voxels : first, overflow + earlier, resolution);
#else
  state.value.chunkGroups = uint[3](min(before, kRow), (before + kRow - 1u) / kRow, 1u);
  state.value.chunks = before;
#endif
}
