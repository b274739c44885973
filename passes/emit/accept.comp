// The paths of a round that count: those before the first whose VPLs no longer fit into the list. `starts` gets their
// numbers, plus 1, at their first slots. Define: LAST 0/1, whether the next round is the last.
//
// The rule does not bias the image. Let M + 1 be the first path whose VPLs no longer fit; that path is discarded, and
// the flux is divided by M. Given M, the first M paths are exchangeable (the condition that they fit is symmetric in
// them), so the mean of any path quantity over them has the expectation of a single path; this is the argument of
// inverse binomial sampling, (r - 1) / (n - 1). Paths that escape count.
#include "device/language.glsl"
#include "emit/rounds.glsl"

const uint kGroup = 256u;
layout(local_size_x = 256) in;

VALUE(restrict, LightPaths, progress);
LIST(readonly, uint, lengths);
LIST(writeonly, uint, starts);
COUNTERS { uint paths, rays, vpls, escaped; } counters;

layout(push_constant) uniform Constants { uint count; } constants;

shared uint sums[kGroup];
shared uint fitting;

// The sum over this invocation and those before it.
uint prefixSum(uint own) {
  uint i = gl_LocalInvocationID.x;
  sums[i] = own;
  barrier();
  for (uint step_ = 1u; step_ < kGroup; step_ *= 2u) {
    uint before = i >= step_ ? sums[i - step_] : 0u;
    barrier();
    sums[i] += before;
    barrier();
  }
  return sums[i];
}

// The number of paths that will probably fill the list.
uint pathsOfNextRound(LightPaths p) {
  uint tried = p.first + p.count, left = kPathsPerVpl * constants.count + kPathsBeside - tried;
  if (p.full != 0u) return 0u;
#if LAST
  return left;
#else
  float missing = 1.5 * float(constants.count - p.stored) + 16.0;
  return uint(min(ceil(missing * float(tried) / max(float(p.stored), 1.0)), float(left)));
#endif
}

void main() {
  uint i = gl_LocalInvocationID.x;
  LightPaths p = progress.value;
  for (uint base = 0u; base < p.count && p.full == 0u; base += kGroup) {
    uint within = min(p.count - base, kGroup), own = i < within ? lengths.list[base + i] : 0u;
    uint end = p.stored + prefixSum(own);
    bool fits = i < within && end <= constants.count;
    if (fits && own > 0u) starts.list[end - own] = p.first + base + i + 1u;
    if (i == 0u) fitting = 0u;
    barrier();
    if (fits) atomicAdd(fitting, 1u);
    barrier();
    p.paths += fitting;
    p.stored += fitting > 0u ? sums[fitting - 1u] : 0u;
    p.full = uint(fitting < within);
    barrier();
  }
  if (i > 0u) return;
  uint next = p.count > 0u ? pathsOfNextRound(p) : 0u;
  uvec2 groups = groupsOf(next);
  p.groupsX = groups.x;
  p.groupsY = groups.y;
  p.first += p.count;
  p.count = next;
  progress.value = p;
  counters.paths = p.paths;
}
