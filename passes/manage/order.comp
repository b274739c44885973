// Two work groups: sort Lc descending and L' ascending by W = I + 1 / (density + CONST), with the density
// of the reused VPLs.
#include "vpls/vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"
#include "manage/memory.glsl"
#include "manage/radix_sort.glsl"
#include "manage/attempt.glsl"

layout(local_size_x = GROUP) in;

// In units of 2^-22, below 2^24.
uint weightOf(uint importance, uint cell) {
  uint sparse = (1u << 30) / (64u * densityAt(cell) + densityConstant64ths);
  return (importance + sparse) >> 2;
}

void main() {
  bool old = gl_WorkGroupID.x == 1u;
  uint count = old ? state.oldCount : state.candidateCount, first = old ? oldList() : candidateList();
  for (uint i = gl_LocalInvocationIndex; i < count; i += GROUP) {
    uint index = lists.entries[first + i].y;
    if (old)
      lists.entries[first + i].x = weightOf(slotRecords.list[index].importance, slotRecords.list[index].cell);
    else
      lists.entries[first + i].x = descending(weightOf(candidateRecords.list[index].x, candidateRecords.list[index].y));
  }
  groupBarrier();
  radixSort(first, old ? slots : candidateCount, count, 24u);  // an even number of rounds, so the result is at `first`
}
