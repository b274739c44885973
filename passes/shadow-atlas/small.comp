// Second of two steps: pairs of a VPL and a triangle that covers few texels, one pair per invocation.
#include "shadow-atlas/pair.glsl"

layout(local_size_x = 64) in;  // kSmallPerGroup

layout(push_constant) uniform Constants {
  uint step_;
  uint capacity;
  int size;
  float planeEpsilon;
#ifdef MOVER_SLACK
  float moverSlack;  // frames
#endif
};

void main() {
#ifdef MASKED
  uint count = steps.list[step_].maskedSmall.count;
#else
  uint count = steps.list[step_].small.count;
#endif
  uint entry = (gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x) * kSmallPerGroup + gl_LocalInvocationIndex;
  if (entry == 0u) {
    if (kMasked) atomicAdd(counters.masked, count);
    else atomicAdd(counters.small, count);
  }
  if (entry >= count) return;
  Pair pair = loadPair(pairs.list[smallPlace(entry, capacity, kMasked)], size, planeEpsilon, false
#ifdef MOVER_SLACK
                       , moverSlack
#endif
  );

  vec2 texel = pair.box.lo;
  float toMap = 2.0 / float(size);
  do {
    rasterise(pair, texel, true, toMap);
    texel.x += 1.0;
    bool next = texel.x > pair.box.hi.x;
    texel = next ? vec2(pair.box.lo.x, texel.y + 1.0) : texel;
  } while (texel.y <= pair.box.hi.y);
}
