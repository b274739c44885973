// One work group: the candidates Lc, thinned by the inverse transform of the CDF of importance. K samples at equal
// distances from a random start on [0, K sum I) hit a candidate with probability min(1, K I / sum I); one that is hit
// several times is taken once (systematic, without replacement). Sums are integers below 2^57.
#include "device/long.glsl"
#include "sampling/random.glsl"
#include "vpls/vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"
#include "manage/memory.glsl"

layout(local_size_x = GROUP) in;

const uint kThinStream = 0x7468696eu;  // keeps the random numbers of this kernel apart from others

// With placement `light`, the same with light instead of importance, after reuse.comp and for the free slots. The
// density of the candidates is that of the ends of eye paths, in proportion to importance, so I B / p reduces to the
// light B, which is the direct light plus a share of the mean for further bounces.
shared Long groupSums[GROUP];
uint lightFloor = 0u;

uint importanceOf(uint i) {
  uint importance = candidateRecords.list[i].x;
  return importance == kHitNothing ? 0u : importance + lightFloor;
}

// Sum of the importances before this invocation's run, and over all.
Long importanceBefore(Run run, out Long total) {
  Long sum = longOf(0u), before = longOf(0u);
  for (uint i = run.begin; i < run.end; ++i) sum = plus(sum, longOf(importanceOf(i)));
  groupSums[gl_LocalInvocationIndex] = sum;
  groupBarrier();
  total = longOf(0u);
  for (uint i = 0u; i < GROUP; ++i) {
    if (i == gl_LocalInvocationIndex) before = total;
    total = plus(total, groupSums[i]);
  }
  return before;
}

void main() {
  Run run = runOf(candidateCount);
  Long total;
  Long before = importanceBefore(run, total);
  uint samplesWanted = keepCount > 0u ? keepCount : listLimit - state.reused;
  if (placement == kPlacementLight && counters.candidates > 0u) {
    lightFloor = lowBits(dividedBy(times(total, lightFloor64ths), times(longOf(counters.candidates), 64u)));
    if (total == longOf(0u)) lightFloor = 1u;  // without light all count the same
    groupBarrier();
    before = importanceBefore(run, total);
  }
  Long start = shiftedRight(times(total, randomStream(seed, frameIndex, kThinStream, 0u) >> 8), 24);
  Long spacing = total == longOf(0u) ? longOf(1u) : total;

  uint count = 0u, all;
  Long sum = before, samples = dividedBy(plus(times(sum, samplesWanted), start), spacing);  // before the candidate
  for (uint i = run.begin; i < run.end; ++i) {
    sum = plus(sum, longOf(importanceOf(i)));
    Long next = dividedBy(plus(times(sum, samplesWanted), start), spacing);
    if (isLess(samples, next)) ++count;
    samples = next;
  }
  uint place = candidateList() + sumBefore(count, all);
  sum = before;
  samples = dividedBy(plus(times(sum, samplesWanted), start), spacing);
  for (uint i = run.begin; i < run.end; ++i) {
    sum = plus(sum, longOf(importanceOf(i)));
    Long next = dividedBy(plus(times(sum, samplesWanted), start), spacing);
    if (isLess(samples, next)) lists.entries[place++] = uvec2(0u, i);
    samples = next;
  }
  if (gl_LocalInvocationIndex == 0u) state.candidateCount = all;
}
