// One slot per invocation: the VPL stays with its new importance, a candidate moves in, or the slot is empty. Define:
// RATED 0/1: whether the candidates have an importance.
#include "scene/objects.glsl"
#include "vpls/vpl.glsl"
#include "manage/memory.glsl"
#include "manage/turnover.glsl"
#include "manage/new_vpl.glsl"

layout(local_size_x = 64) in;

#if RATED
uniform usamplerBuffer candidateImportance;  // bits of floats, so that they pass unchanged
#endif
uniform usamplerBuffer vplImportance;  // likewise
uniform usamplerBuffer vpls;
layout(std430) writeonly buffer ListBlock { VplState vpls[]; } list;

VplState fromCandidate(uint i) {
#if RATED
  return newVpl(i, uintBitsToFloat(texelFetch(candidateImportance, int(i)).r));
#else
  return newVpl(i, 0.0);
#endif
}

VplState keptIn(uint slot) {
  VplState vpl = loadVplState(vpls, slot);
  // A VPL that failed Eq. 1 and is spared is compared with the same importance in the next frame.
  bool spared = mostFailing() < slots && (slotRecords.list[slot].flags & kAccepted) == 0u;
  vpl.importance = spared ? vpl.previousImportance : uintBitsToFloat(texelFetch(vplImportance, int(slot)).r);
  return vpl;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint source = sources.list[slot];
  if (source >= kFirstCandidate)
    list.vpls[slot] = fromCandidate(source - kFirstCandidate);
  else
    list.vpls[slot] = source == kKept ? keptIn(slot) : kNoVplState;
}
