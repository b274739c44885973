// One work group: the candidates that hit something fill the slots in their order.
#include "scene/objects.glsl"
#include "vpls/vpl.glsl"
#include "manage/new_vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"

layout(local_size_x = GROUP) in;

layout(std430) writeonly buffer ListBlock { VplState vpls[]; } list;
layout(std430) buffer CountersBlock { uint candidates, alive; } counters;

bool hit(uint i) { return loadCandidate(candidates, i).side != kNoSide; }

void main() {
  Run run = runOf(uint(CANDIDATES));
  uint count = 0u, total;
  for (uint i = run.begin; i < run.end; ++i) count += hit(i) ? 1u : 0u;
  uint slot = sumBefore(count, total);
  for (uint i = run.begin; i < run.end && slot < uint(COUNT); ++i)
    if (hit(i)) list.vpls[slot++] = newVpl(i, 0.0);
  for (uint empty = total + gl_LocalInvocationIndex; empty < uint(COUNT); empty += GROUP)
    list.vpls[empty] = kNoVplState;
  if (gl_LocalInvocationIndex == 0u) {
    counters.candidates = total;
    counters.alive = min(total, uint(COUNT));
  }
}
