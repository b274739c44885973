// One work group: which VPLs are reused, and L', those that are not. Eq. 1 has decided this unless the list got
// shorter, the gaze has jumped or light is lost, in which case the most important stay; `random` takes any of the
// VPLs.
#include "vpls/vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"
#include "manage/memory.glsl"
#include "manage/turnover.glsl"
#include "manage/radix_sort.glsl"

layout(local_size_x = GROUP) in;

bool eligible(uint slot) {
  return (slotRecords.list[slot].flags & (reuse == kReuseRandom || mostFailing() < slots ? kAlive : kAccepted)) != 0u;
}
bool failed(uint slot) {
  return (slotRecords.list[slot].flags & kAlive) != 0u && sources.list[slot] != kKept;
}

// VPLs that Eq. 1 reuses, or that `random` does.
uint reusedByRule() {
  if (reuse == kReuseRandom && randomShare1024ths > 0u) return (state.alive * randomShare1024ths + 512u) >> 10;
  uint spared = state.alive - min(state.alive, mostFailing());
  return max(state.accepted, spared);
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  Run run = runOf(slots);
  uint count = 0u, total;
  for (uint slot = run.begin; slot < run.end; ++slot) count += eligible(slot) ? 1u : 0u;
  uint place = oldList() + sumBefore(count, total);
  for (uint slot = run.begin; slot < run.end; ++slot)
    if (eligible(slot)) lists.entries[place++] = uvec2(slotRecords.list[slot].key, slot);
  groupBarrier();

  uint reused = min(reusedByRule(), listLimit), first = oldList();
  reused -= min(reused, contested);
  reused = min(reused, state.alive - min(state.alive, outdated()));
  if (reused < total) first = radixSort(first, slots, total, 24u);
  for (uint i = lane; i < reused; i += GROUP) {
    uint slot = lists.entries[first + i].y;
    sources.list[slot] = kKept;
    atomicAdd(density.cells[slotRecords.list[slot].cell], 1u);
  }
  groupBarrier();

  count = 0u;
  for (uint slot = run.begin; slot < run.end; ++slot) count += failed(slot) ? 1u : 0u;
  place = oldList() + sumBefore(count, total);
  for (uint slot = run.begin; slot < run.end; ++slot)
    if (failed(slot)) lists.entries[place++] = uvec2(0u, slot);
  if (lane == 0u) {
    state.reused = reused;
    state.oldCount = placement == kPlacementLight ? 0u : total;
  }
}
