// Second of two steps: pairs of a VPL and a triangle that covers many texels or is cut by the horizon. Eight
// invocations per pair process its box in blocks of 8x8 texels, a row at a time.
#include "shadow-atlas/pair.glsl"

layout(local_size_x = 64) in;  // 8 * kLargePerGroup

layout(push_constant) uniform Constants {
  uint step_;
  uint capacity;
  int size;
  uint slice, slices;  // share of every pair's blocks; some devices limit loops to 65,535 turns in total
  float planeEpsilon;
#ifdef MOVER_SLACK
  float moverSlack;  // frames
#endif
};

void main() {
#ifdef MASKED
  uint count = steps.list[step_].maskedLarge.count;
#else
  uint count = steps.list[step_].large.count;
#endif
  uint entry = (gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x) * kLargePerGroup + gl_LocalInvocationIndex / 8u;
  if (entry == 0u && gl_LocalInvocationIndex == 0u && slice == 0u) {
    if (kMasked) atomicAdd(counters.masked, count);
    else atomicAdd(counters.large, count);
  }
  if (entry >= count) return;
  Pair pair = loadPair(pairs.list[largePlace(entry, capacity, kMasked)], size, planeEpsilon, true
#ifdef MOVER_SLACK
                       , moverSlack
#endif
  );
  if (isEmpty(pair.box)) return;

  int width = int(pair.box.hi.x - pair.box.lo.x) / 8 + 1;
  int blocks = width * (int(pair.box.hi.y - pair.box.lo.y) / 8 + 1);
  float perRow = 1.0 / float(width), toMap = 2.0 / float(size);
  int block = int(slice);
  while (block < blocks) {
    // The search for the next block that may be hit is a loop of its own: every device skips turns of a loop, but not
    // every one skips the sides of a branch. The loops end at their heads, see weight-map/scatter.comp.
    vec2 corner = vec2(0.0);
    bool reached = false;
    while (!reached && block < blocks) {
      float row = floor((float(block) + 0.5) * perRow);
      corner = pair.box.lo + 8.0 * vec2(float(block - int(row) * width), row);
      reached = mayHit(pair.test, (corner + 4.0) * toMap - 1.0, 3.5 * toMap);
      block += int(slices);
    }

    vec2 texel = corner + vec2(float(gl_LocalInvocationIndex % 8u), 0.0);
    vec2 last = min(corner + 7.0, pair.box.hi);
    if (!reached) last.y = -1.0;
    while (texel.y <= last.y) {
      rasterise(pair, texel, texel.x <= last.x, toMap);
      texel.y += 1.0;
    }
  }
}
