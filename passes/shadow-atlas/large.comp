// Second of two steps: triangles that cover many texels or are cut by the horizon. Eight invocations per triangle
// process its box in blocks of 8x8 texels, a row at a time. The work groups along z share the blocks, as some devices
// limit loops to 65,535 turns in total.
#include "shadow-atlas/pair.glsl"

layout(local_size_x = 64) in;  // 8 * kLargePerGroup

layout(std430) readonly buffer StepsBlock { Step list[]; } steps;
layout(std430) readonly buffer ListedBlock { VplSet list[]; } listed;

layout(push_constant) uniform Constants {
  uint step_;
  uint capacity;  // most sets of a step
  int size;
  float planeEpsilon;
#ifdef MOVER_SLACK
  float moverSlack;  // frames
#endif
};

// Draws a share of the pair's blocks.
void draw(Pair pair) {
  float toMap = 2.0 / float(size);
  int width = int(pair.box.hi.x - pair.box.lo.x) / 8 + 1;
  int blocks = isEmpty(pair.box) ? 0 : width * (int(pair.box.hi.y - pair.box.lo.y) / 8 + 1);
  float perRow = 1.0 / float(width);
  int block = int(gl_WorkGroupID.z);
  while (block < blocks) {
    // The search for the next block that may be hit is a loop of its own: every device skips turns of a loop, but not
    // every one skips the sides of a branch. The loops end at their heads, see weight-map/scatter.comp.
    vec2 corner = vec2(0.0);
    bool reached = false;
    while (!reached && block < blocks) {
      float row = floor((float(block) + 0.5) * perRow);
      corner = pair.box.lo + 8.0 * vec2(float(block - int(row) * width), row);
      reached = mayHit(pair.test, (corner + 4.0) * toMap - 1.0, 3.5 * toMap);
      block += int(gl_NumWorkGroups.z);
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

void main() {
  uint entry = (gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x) * kLargePerGroup + gl_LocalInvocationIndex / 8u;
#ifdef MASKED
  if (entry >= steps.list[step_].maskedLarge.count) return;
#else
  if (entry >= steps.list[step_].large.count) return;
#endif
  VplSet set = listed.list[kMasked ? capacity - 1u - entry : entry];
  uint batch = set.triangle >> kTriangleBits, index = set.triangle & kTriangleMask;
  Triangle triangle = loadTriangle(index);
  while (set.vpls != 0u) {
    VplView view = views.list[batch * kBatch + uint(findLSB(set.vpls))];
    set.vpls &= set.vpls - 1u;
    draw(pairOf(view, triangle, index, size, planeEpsilon, true
#ifdef MOVER_SLACK
                , moverSlack
#endif
    ));
  }
}
