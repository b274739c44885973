// First step of a prefix sum: the sum of each block of 256 values.
#include "voxelize/state.glsl"

layout(local_size_x = 256) in;

#if MARKS
layout(std430) readonly buffer MarksBlock { uint words[]; } marks;
#else
layout(std430) readonly buffer ChunksBlock { uint list[]; } chunks;
#endif
layout(std430) writeonly buffer BlocksBlock { uint sums[]; } blocks;

layout(push_constant) uniform Constants { uint count; };

shared uint sum;

void main() {
  if (gl_LocalInvocationIndex == 0u) sum = 0u;
  barrier();
  uint block = groupIndex(), i = block * kScanBlock + gl_LocalInvocationIndex;
#if MARKS
  uint value = i < count ? uint(bitCount(marks.words[i])) : 0u;
#else
  uint value = i < count ? chunks.list[i] : 0u;
#endif
  if (value != 0u) atomicAdd(sum, value);
  barrier();
  if (gl_LocalInvocationIndex == 0u && block * kScanBlock < count) blocks.sums[block] = sum;
}
