// Zeroes the sums of a batch of voxels; one invocation per side.
#include "voxelize/state.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer StateBlock { State value; } state;
layout(std430) writeonly buffer SumsBlock { uint words[]; } sums;

layout(push_constant) uniform Constants {
  uint phase;
  uint base;   // first voxel of the batch, within the phase
  uint batch;  // voxels
};

void main() {
  uint side = groupIndex() * 64u + gl_LocalInvocationIndex;
  if (side >= 2u * min(batch, state.value.phases[phase].voxels - min(base, state.value.phases[phase].voxels))) return;
  for (uint i = 0u; i < kSumWords; ++i) sums.words[side * kSumWords + i] = 0u;
}
