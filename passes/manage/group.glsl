// Processes a whole list with one work group. Every invocation takes a run of neighbouring elements, so that the
// order of the list is the order of the invocations. Needs GROUP, the size of the work group.
#ifndef FOVEA_MANAGE_GROUP_GLSL
#define FOVEA_MANAGE_GROUP_GLSL

struct Run { uint begin, end; };

Run runOf(uint count) {
  uint length_ = (count + GROUP - 1u) / GROUP;
  uint begin = min(gl_LocalInvocationIndex * length_, count);
  return Run(begin, min(begin + length_, count));
}

// Makes the writes of the work group visible to all of it.
void groupBarrier() {
  memoryBarrierBuffer();
  memoryBarrierShared();
  barrier();
}

shared uint groupValues[GROUP];

// Sum of `value` over the invocations before this one, and over all.
uint sumBefore(uint value, out uint total) {
  groupValues[gl_LocalInvocationIndex] = value;
  groupBarrier();
  uint before = 0u;
  total = 0u;
  for (uint i = 0u; i < GROUP; ++i) {
    if (i == gl_LocalInvocationIndex) before = total;
    total += groupValues[i];
  }
  groupBarrier();
  return before;
}

#endif
