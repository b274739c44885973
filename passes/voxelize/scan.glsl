// Sums over work groups of 256 values: of the triangles' chunks or, with MARKS, of the marked cells in words of 32.
#include "voxelize/state.glsl"

shared uint partial[256];

// Sum of the values before this invocation's, and of all values.
uint exclusiveSum(uint value, out uint total) {
  uint i = gl_LocalInvocationIndex;
  partial[i] = value;
  barrier();
  for (uint d = 1u; d < 256u; d *= 2u) {
    uint left = i >= d ? partial[i - d] : 0u;
    barrier();
    partial[i] += left;
    barrier();
  }
  total = partial[255];
  uint before = partial[i] - value;
  barrier();
  return before;
}
