#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// One work group: the candidates Lc, thinned by the inverse transform of the CDF of importance. K samples at equal
// distances from a random start on [0, K sum I) hit a candidate with probability min(1, K I / sum I); one that is hit
// several times is taken once (systematic, without replacement). Sums are integers below 2^57.
#include "common/random.glsl"
#include "common/vpl.glsl"
#define GROUP 64
#include "manage/group.glsl"
#include "manage/memory.glsl"

layout(local_size_x = GROUP) in;

const uint kThinStream = 0x7468696eu;  // keeps the random numbers of this kernel apart from others

// With placement `light`, the same with light instead of importance, after reuse.comp and for the free slots. The
// density of the candidates is that of the ends of eye paths, in proportion to importance, so I B / p reduces to the
// light B, which is the direct light plus a share of the mean for further bounces.
shared uint64_t groupSums[GROUP];
uint lightFloor = 0u;

uint importanceOf(uint i) {
  uint importance = candidateRecords.list[i].x;
  return importance == kHitNothing ? 0u : importance + lightFloor;
}

// Sum of the importances before this invocation's run, and over all.
uint64_t importanceBefore(Run run, out uint64_t total) {
  uint64_t sum = 0ul, before = 0ul;
  for (uint i = run.begin; i < run.end; ++i) sum += uint64_t(importanceOf(i));
  groupSums[gl_LocalInvocationIndex] = sum;
  groupBarrier();
  total = 0ul;
  for (uint i = 0u; i < GROUP; ++i) {
    if (i == gl_LocalInvocationIndex) before = total;
    total += groupSums[i];
  }
  return before;
}

void main() {
  Run run = runOf(candidateCount);
  uint64_t total;
  uint64_t before = importanceBefore(run, total);
  uint samplesWanted = keepCount > 0u ? keepCount : listLimit - state.reused;
  if (placement == kPlacementLight && counters.candidates > 0u) {
    lightFloor = uint(total * uint64_t(lightFloor64ths) / (64ul * uint64_t(counters.candidates)));
    if (total == 0ul) lightFloor = 1u;  // without light all count the same
    groupBarrier();
    before = importanceBefore(run, total);
  }
  uint64_t start = (total * uint64_t(randomStream(seed, frameIndex, kThinStream, 0u) >> 8)) >> 24;
  uint64_t spacing = max(total, 1ul);

  uint count = 0u, all;
  uint64_t sum = before, samples = (samplesWanted * sum + start) / spacing;  // before the candidate
  for (uint i = run.begin; i < run.end; ++i) {
    sum += uint64_t(importanceOf(i));
    uint64_t next = (samplesWanted * sum + start) / spacing;
    if (next > samples) ++count;
    samples = next;
  }
  uint place = candidateList() + sumBefore(count, all);
  sum = before;
  samples = (samplesWanted * sum + start) / spacing;
  for (uint i = run.begin; i < run.end; ++i) {
    sum += uint64_t(importanceOf(i));
    uint64_t next = (samplesWanted * sum + start) / spacing;
    if (next > samples) lists.entries[place++] = uvec2(0u, i);
    samples = next;
  }
  if (gl_LocalInvocationIndex == 0u) state.candidateCount = all;
}
