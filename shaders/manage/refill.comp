// One work group, reuse `none`: all old VPLs are deleted and the first candidates fill the slots.
#include "common/vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"
#include "manage/memory.glsl"

layout(local_size_x = GROUP) in;

bool hit(uint i) { return candidateRecords.list[i].x != kHitNothing; }

void main() {
  Run run = runOf(candidateCount);
  uint count = 0u, total;
  for (uint i = run.begin; i < run.end; ++i) count += hit(i) ? 1u : 0u;
  uint slot = sumBefore(count, total);
  for (uint i = run.begin; i < run.end && slot < listLimit; ++i)
    if (hit(i)) sources.list[slot++] = kFirstCandidate + i;
  if (gl_LocalInvocationIndex == 0u) {
    counters.deleted = state.alive;
    counters.added = counters.alive = min(total, listLimit);
  }
}
