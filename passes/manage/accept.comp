// One slot and one candidate per invocation: importance in fixed point, Eq. 1, and cells of the density grid. Define:
// RATED 0/1: whether the candidates have an importance.
#include "scene/scene.glsl"
#include "sampling/random.glsl"
#include "vpls/vpl.glsl"
#include "manage/acceptance.glsl"
#include "manage/memory.glsl"
#include "manage/turnover.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer candidates;
#if RATED
uniform samplerBuffer candidateImportance;
#endif
uniform samplerBuffer vplImportance;
uniform usamplerBuffer vpls;

const uint kManageStream = 0x6d616e61u;  // keeps the random numbers of this pass apart from others

void occupy(uint cell) {
  if ((atomicOr(density.cells[cell], kOccupied) & kOccupied) == 0u) atomicAdd(state.occupied, 1u);
}

void testSlot(uint slot) {
  sources.list[slot] = kEmpty;
  VplState vpl = loadVplState(vpls, slot);
  if (!(vpl.life > 0.0)) {
    slotRecords.list[slot] = SlotRecord(0u, 0u, 0u, 0u);
    return;
  }
  uint importance = quantiseImportance(texelFetch(vplImportance, int(slot)).r);
  uint before = quantiseImportance(vpl.previousImportance);
  uint stream = randomStream(seed, frameIndex, kManageStream, slot);
  uint u = hashCombine(stream, 0u) >> 8;
  // Unless it has a share of its own, `random` reuses as many as `linear` would.
  bool accepted = reuse == kReuseCosine ? acceptedCosine(importance, before, u) : acceptedLinear(importance, before, u);
  uint key = reuse == kReuseRandom ? hashCombine(stream, 1u) >> 8 : kImportanceMax - importance;
  if (reuse != kReuseRandom && mostFailing() < slots) key = key >> 1 | (accepted ? 0u : 0x800000u);  // failed last
  uint cell = cellOf(vpl.position);
  slotRecords.list[slot] = SlotRecord(importance, kAlive | (accepted ? kAccepted : 0u), cell, key);
  occupy(cell);
  atomicAdd(state.alive, 1u);
  if (accepted) atomicAdd(state.accepted, 1u);
}

void readCandidate(uint i) {
  Candidate candidate = loadCandidate(candidates, i);
  if (candidate.side == kNoSide) {
    candidateRecords.list[i] = uvec2(kHitNothing, 0u);
    return;
  }
  uint cell = cellOf(candidate.position);
  uint value = quantiseLight(candidate.luminance, frame.exposure);
#if RATED
  if (placement != kPlacementLight) value = quantiseImportance(texelFetch(candidateImportance, int(i)).r);
#endif
  candidateRecords.list[i] = uvec2(value, cell);
  occupy(cell);
  atomicAdd(counters.candidates, 1u);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < slots) testSlot(i);
  if (i < candidateCount) readCandidate(i);
}
