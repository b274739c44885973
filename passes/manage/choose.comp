// One work group: Algorithm 2, and a slot for each VPL that it adds.
//
// The serial loop adds attempt a if its cell holds fewer than D_MAX VPLs and the list fewer than N_MAX. Until the
// list is full, a cell takes its first D_MAX - density attempts, so the first test depends only on the rank of a
// among the attempts in its cell; the second then takes the first N_MAX - reused of those that passed. Both together
// equal the serial loop bit for bit.
#include "vpls/vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"
#include "manage/memory.glsl"
#include "manage/radix_sort.glsl"
#include "manage/attempt.glsl"

layout(local_size_x = GROUP) in;

// D_MAX: the parameter, or three times the density of a list spread evenly over the cells that hold a
// VPL or a candidate.
uint densityLimit() {
  if (maxDensity > 0u) return maxDensity;
  uint cells = max(state.occupied, 1u);
  return max(2u, (3u * listLimit + cells - 1u) / cells);
}

// Marks the attempts whose cell is full.
void refuseDense(uint count) {
  uint lane = gl_LocalInvocationIndex, first = attemptList(), limit = densityLimit();
  for (uint a = lane; a < count; a += GROUP) {
    uint attempt = attemptOf(a);
    attempts.list[a] = attempt;
    lists.entries[first + a] = uvec2(cellOfAttempt(attempt), a);
  }
  groupBarrier();
  uint sorted = radixSort(first, max(candidateCount, slots), count, kCellBits);
  for (uint i = lane; i < count; i += GROUP) {
    uint cell = lists.entries[sorted + i].x;
    if (i == 0u || lists.entries[sorted + i - 1u].x != cell) segments.first[cell] = i;
  }
  groupBarrier();
  for (uint i = lane; i < count; i += GROUP) {
    uvec2 entry = lists.entries[sorted + i];
    if (densityAt(entry.x) + i - segments.first[entry.x] >= limit) attempts.list[entry.y] |= kRefused;
  }
  groupBarrier();
}

// Takes the first attempts that fit into the list: old VPLs stay in their slots, candidates go to `added`. Returns
// the number of candidates taken.
uint takeAttempts(uint count, out uint kept) {
  Run run = runOf(count);
  uint passed = 0u, total;
  for (uint a = run.begin; a < run.end; ++a) passed += (attempts.list[a] & kRefused) == 0u ? 1u : 0u;
  uint room = listLimit - state.reused, before = sumBefore(passed, total);
  uint fresh = 0u, old = 0u, dense = 0u, place = before;
  for (uint a = run.begin; a < run.end && place < room; ++a) {
    uint attempt = attempts.list[a];
    if ((attempt & kRefused) != 0u) {
      ++dense;
      continue;
    }
    ++place;
    if ((attempt & kFresh) != 0u) {
      ++fresh;
    } else {
      ++old;
      sources.list[attempt] = kKept;
    }
  }
  uint addedCount, denseCount;
  uint next = sumBefore(fresh, addedCount);
  place = before;
  for (uint a = run.begin; a < run.end && place < room; ++a) {
    uint attempt = attempts.list[a];
    if ((attempt & kRefused) != 0u) continue;
    ++place;
    if ((attempt & kFresh) != 0u) added.list[next++] = attempt & ~kFresh;
  }
  sumBefore(old, kept);
  sumBefore(dense, denseCount);
  kept += state.reused;
  if (gl_LocalInvocationIndex == 0u) counters.dense = denseCount;
  return addedCount;
}

// Assigns the free slots to the new VPLs in rising order.
void fillSlots(uint addedCount) {
  Run run = runOf(slots);
  uint unused = 0u, total;
  for (uint slot = run.begin; slot < run.end; ++slot) unused += sources.list[slot] == kEmpty ? 1u : 0u;
  uint next = sumBefore(unused, total);
  for (uint slot = run.begin; slot < run.end && next < addedCount; ++slot)
    if (sources.list[slot] == kEmpty) sources.list[slot] = kFirstCandidate + added.list[next++];
}

void main() {
  uint count = attemptCount(), kept;
  refuseDense(count);
  uint addedCount = takeAttempts(count, kept);
  groupBarrier();
  fillSlots(addedCount);
  if (gl_LocalInvocationIndex == 0u) {
    counters.kept = kept;
    counters.deleted = state.alive - kept;
    counters.added = addedCount;
    counters.rejected = state.alive - state.accepted;
    counters.alive = kept + addedCount;
  }
}
