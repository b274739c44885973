// One slot per invocation: the VPL stays with its new importance, a candidate moves in, or the slot is empty.
#include "common/scene.glsl"
#include "common/vpl.glsl"
#include "manage/memory.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer candidates;
uniform usamplerBuffer candidateImportance;  // bits of floats, so that they pass unchanged
uniform usamplerBuffer vplImportance;
uniform usamplerBuffer vpls;
layout(std430) writeonly buffer ListBlock { uvec4 texels[]; } list;  // VplState: five per slot

const uint kOne = 0x3f800000u;  // bits of 1.0

// Normal in the space of its object, which is the world's if the object never moves.
uvec3 localNormal(uvec4 normalObject, uint place) {
  uint object = uint(uintBitsToFloat(normalObject.w));
  if (objectDeforms(object))
    return floatBitsToUint(uintBitsToFloat(normalObject.xyz) * triangleAxes(uint(uintBitsToFloat(place))));
  return object == 0u ? normalObject.xyz : floatBitsToUint(normalToObject(object, uintBitsToFloat(normalObject.xyz)));
}

void writeCandidate(uint slot, int i) {
  uvec4 positionSide = texelFetch(candidates, 4 * i), normalObject = texelFetch(candidates, 4 * i + 1);
  uvec4 reflectance = texelFetch(candidates, 4 * i + 2), localPosition = texelFetch(candidates, 4 * i + 3);
  uint importance = texelFetch(candidateImportance, i).r;
  list.texels[5u * slot] = uvec4(positionSide.xyz, importance);
  list.texels[5u * slot + 1u] = uvec4(normalObject.xyz, kOne);
  list.texels[5u * slot + 2u] = uvec4(reflectance.xyz, positionSide.w);
  list.texels[5u * slot + 3u] = uvec4(localPosition.xyz, normalObject.w);
  list.texels[5u * slot + 4u] = uvec4(localNormal(normalObject, localPosition.x), importance);
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint source = sources.list[slot];
  if (source >= kFirstCandidate) {
    writeCandidate(slot, int(source - kFirstCandidate));
    return;
  }
  for (uint t = 0u; t < 5u; ++t)
    list.texels[5u * slot + t] = source == kKept ? texelFetch(vpls, int(5u * slot + t)) : uvec4(0u);
  // A VPL that failed Eq. 1 and is spared is compared with the same importance in the next frame.
  bool spared = mostRejected < slots && (slotRecords.list[slot].flags & kAccepted) == 0u;
  if (source == kKept)
    list.texels[5u * slot].w = spared ? texelFetch(vpls, int(5u * slot + 4u)).w : texelFetch(vplImportance, int(slot)).r;
}
