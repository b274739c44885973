// Algorithm 2 as one sequence of attempts to add a VPL. Needs manage/memory.glsl.
#ifndef FOVEA_MANAGE_ATTEMPT_GLSL
#define FOVEA_MANAGE_ATTEMPT_GLSL

// Converts W to a sort key of the candidate list and back, so that the largest comes first.
uint descending(uint weight) { return 0xffffffu - weight; }

// Part 1 makes one attempt for each pair (Lc[j], L'[j]). Part 2 makes one for each remaining candidate or, with order
// `fixed`, for each remaining old VPL, the best first.
uint attemptCount() {
  return order == kOrderFixed ? max(state.candidateCount, state.oldCount) : state.candidateCount;
}

// Returns a slot, or candidate | kFresh.
uint attemptOf(uint number) {
  uint fresh = state.candidateCount, old = state.oldCount;
  if (number >= fresh) return lists.entries[oldList() + old - 1u - (number - fresh)].y;
  uvec2 candidate = lists.entries[candidateList() + number];
  if (number >= old) return candidate.y | kFresh;
  uvec2 vpl = lists.entries[oldList() + number];
  return descending(candidate.x) > vpl.x ? candidate.y | kFresh : vpl.y;
}

uint cellOfAttempt(uint attempt) {
  return (attempt & kFresh) != 0u ? candidateRecords.list[attempt & ~kFresh].y : slotRecords.list[attempt].cell;
}

#endif
