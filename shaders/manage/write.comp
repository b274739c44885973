// One slot per invocation: the VPL stays with its new importance, a candidate moves in, or the slot is empty.
#include "common/scene.glsl"
#include "common/vpl.glsl"
#include "manage/memory.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer candidates;
uniform usamplerBuffer candidateImportance;  // bits of floats, so that they pass unchanged
uniform usamplerBuffer vplImportance;
uniform usamplerBuffer vpls;
layout(std430) writeonly buffer ListBlock { VplState vpls[]; } list;

// Normal in the space of its object, which is the world's if the object never moves.
vec3 localNormal(Candidate candidate) {
  uint object = uint(candidate.object);
  if (objectDeforms(object)) return candidate.normal * triangleAxes(uint(candidate.localPosition.x));
  return object == 0u ? candidate.normal : normalToObject(object, candidate.normal);
}

VplState fromCandidate(uint i) {
  Candidate c = loadCandidate(candidates, i);
  float importance = uintBitsToFloat(texelFetch(candidateImportance, int(i)).r);
  return VplState(c.position, importance, c.normal, 1.0, c.reflectance, c.side, c.localPosition, c.object,
                  localNormal(c), importance);
}

VplState keptIn(uint slot) {
  VplState vpl = loadVplState(vpls, slot);
  // A VPL that failed Eq. 1 and is spared is compared with the same importance in the next frame.
  bool spared = mostRejected < slots && (slotRecords.list[slot].flags & kAccepted) == 0u;
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
