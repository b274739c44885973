// For work groups of 256.
#ifndef FOVEA_SHADOW_ATLAS_COMPACT_GLSL
#define FOVEA_SHADOW_ATLAS_COMPACT_GLSL

shared uint sums[256];

// Number of flags set before this invocation's, and in total.
uint compact(bool flag, out uint total) {
  uint i = gl_LocalInvocationIndex;
  sums[i] = flag ? 1u : 0u;
  barrier();
  for (uint step_ = 1u; step_ < 256u; step_ *= 2u) {
    uint left = i >= step_ ? sums[i - step_] : 0u;
    barrier();
    sums[i] += left;
    barrier();
  }
  total = sums[255];
  uint before = sums[i] - (flag ? 1u : 0u);
  barrier();
  return before;
}

#endif
