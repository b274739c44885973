// Second of two steps: triangles with an alpha mask that cover few texels, one triangle per invocation.
#include "shadow-atlas/pair.glsl"

layout(local_size_x = 64) in;  // kSmallPerGroup

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

void main() {
  uint entry = (gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x) * kSmallPerGroup + gl_LocalInvocationIndex;
  if (entry >= steps.list[step_].maskedSmall.count) return;
  VplSet set = listed.list[capacity + entry];
  uint batch = set.triangle >> kTriangleBits, index = set.triangle & kTriangleMask;
  Triangle triangle = loadTriangle(index);
  while (set.vpls != 0u) {
    VplView view = views.list[batch * kBatch + uint(findLSB(set.vpls))];
    set.vpls &= set.vpls - 1u;
    Pair pair = pairOf(view, triangle, index, size, planeEpsilon, false
#ifdef MOVER_SLACK
                       , moverSlack
#endif
    );
    drawBox(pair, size);
  }
}
