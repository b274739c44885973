// Virtual point lights: their records (records/vpl.h), and how to read them from texel buffers.
#ifndef FOVEA_VPL_GLSL
#define FOVEA_VPL_GLSL

#include "records/vpl.h"

// Whether a slot holds a VPL that emits light.
bool isLit(Vpl v) { return any(notEqual(v.intensity, vec3(0.0))); }

// What empty slots hold, and attempts that hit nothing.
const Vpl kNoVpl = Vpl(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
const VplState kNoVplState = VplState(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0u, vec3(0.0), 0.0, vec3(0.0), 0.0);
const Candidate kNoCandidate = Candidate(vec3(0.0), kNoSide, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

// The VPL of a slot. list: a list of Vpl.
Vpl loadVpl(samplerBuffer list, uint slot) {
  int first = int(slot) * 3;
  vec4 a = texelFetch(list, first), b = texelFetch(list, first + 1), c = texelFetch(list, first + 2);
  return Vpl(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w);
}

// The state of a slot. list: a list of VplState, read as bits, so that whole numbers in it pass unchanged. What a
// caller does not use is not fetched: compilers leave it out.
VplState loadVplState(usamplerBuffer list, uint slot) {
  int first = int(slot) * 5;
  uvec4 a = texelFetch(list, first), b = texelFetch(list, first + 1), c = texelFetch(list, first + 2),
        d = texelFetch(list, first + 3), e = texelFetch(list, first + 4);
  return VplState(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), uintBitsToFloat(b.w),
                  uintBitsToFloat(c.xyz), c.w, uintBitsToFloat(d.xyz), uintBitsToFloat(d.w),
                  uintBitsToFloat(e.xyz), uintBitsToFloat(e.w));
}

uint vplStates(usamplerBuffer list) { return uint(textureSize(list)) / 5u; }  // number of slots

// Candidate i. list: a list of Candidate, read as bits.
Candidate loadCandidate(usamplerBuffer list, uint i) {
  int first = int(i) * 4;
  uvec4 a = texelFetch(list, first), b = texelFetch(list, first + 1), c = texelFetch(list, first + 2),
        d = texelFetch(list, first + 3);
  return Candidate(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), uintBitsToFloat(b.w), uintBitsToFloat(c.xyz),
                   uintBitsToFloat(c.w), uintBitsToFloat(d.xyz), uintBitsToFloat(d.w));
}

#endif
