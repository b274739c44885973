// Stable radix sort of a list of (key, index) by one work group: equal keys keep their order, so ties fall to the lower
// index. Needs manage/memory.glsl, manage/group.glsl; GROUP must be 64, the number of digits.
#ifndef FOVEA_MANAGE_RADIX_SORT_GLSL
#define FOVEA_MANAGE_RADIX_SORT_GLSL

const uint kDigitBits = 6u, kDigits = 64u;
shared uint digitCounts[kDigits * GROUP];  // digit by digit, for each the runs of the invocations

// Turns the counts into the position of the first element of each digit and run.
void scanDigits() {
  uint row = gl_LocalInvocationIndex * GROUP, sum = 0u;
  for (uint i = row; i < row + GROUP; ++i) sum += digitCounts[i];
  uint total;
  uint place = sumBefore(sum, total);
  for (uint i = row; i < row + GROUP; ++i) {
    uint count = digitCounts[i];
    digitCounts[i] = place;
    place += count;
  }
}

// Sorts `count` entries that start at `first` by the lowest `bits` of their keys, ascending. Returns where the sorted
// list starts: at `first`, or at `first` + capacity. Must be called by the whole work group.
uint radixSort(uint first, uint capacity, uint count, uint bits) {
  uint from = first, to = first + capacity, lane = gl_LocalInvocationIndex;
  Run run = runOf(count);
  for (uint shift = 0u; shift < bits; shift += kDigitBits) {
    for (uint digit = 0u; digit < kDigits; ++digit) digitCounts[digit * GROUP + lane] = 0u;
    for (uint e = run.begin; e < run.end; ++e)
      ++digitCounts[(lists.entries[from + e].x >> shift & (kDigits - 1u)) * GROUP + lane];
    groupBarrier();
    scanDigits();
    groupBarrier();
    for (uint e = run.begin; e < run.end; ++e) {
      uvec2 entry = lists.entries[from + e];
      uint counter = (entry.x >> shift & (kDigits - 1u)) * GROUP + lane;
      uint place = digitCounts[counter]++;
      lists.entries[to + place] = entry;
    }
    groupBarrier();
    uint swap = from;
    from = to;
    to = swap;
  }
  return from;
}

#endif
