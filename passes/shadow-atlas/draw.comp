#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_basic : require
// First of two steps: finds the texels that triangles may cover in the maps of a batch of VPLs. It draws the opaque
// triangles that cover few, and lists the others for masked.comp and large.comp. An invocation takes kTriangles
// triangles, so that a VPL is read once for all of them.
#include "shadow-atlas/pair.glsl"

layout(local_size_x = kDrawGroup) in;

layout(std430) buffer StepsBlock { uint words[]; } steps;  // Step
layout(std430) writeonly buffer ListedBlock { VplSet list[]; } listed;
layout(std430) buffer CountersBlock { uint maps, small, large, masked; } counters;

layout(push_constant) uniform Constants {
  uint step_;
  uint firstTriangle;
  uint triangleCount;
  uint capacity;  // most sets of a step
  int size;
  float planeEpsilon;
  uint alphaMask;
#ifdef MOVER_SLACK
  float moverSlack;  // frames
#endif
};

// Lists a triangle and the VPLs in whose maps it is to be drawn. Opaque sets are stored from the front of the first half
// of the list, and large masked ones from its back. They never meet, as a triangle is either opaque or masked. Small
// masked sets fill the second half.
void append(uint index, uint vpls, bool large, bool masked) {
  uint list = kListWords * (kStepLists * step_ + (masked ? large ? 3u : 2u : 1u));  // a WorkList of the step
  uint entry = atomicAdd(steps.words[list + 3u], 1u);
  uint place = !masked ? entry : large ? capacity - 1u - entry : capacity + entry;
  listed.list[place] = VplSet(gl_WorkGroupID.y << kTriangleBits | index, vpls);
  // The first entry of each group adds a group to the indirect dispatch.
  uint perGroup = large ? kLargePerGroup : kSmallPerGroup, group = entry / perGroup;
  bool inFirstRow = group < kGroupsPerRow;
  if (entry % perGroup == 0u && (inFirstRow || group % kGroupsPerRow == 0u))
    atomicAdd(steps.words[list + (inFirstRow ? 0u : 1u)], 1u);
}

void main() {
  uint first = firstTriangle + gl_WorkGroupID.x * (kDrawGroup * kTriangles) + gl_LocalInvocationIndex;
  uint end = firstTriangle + triangleCount;
  Triangle triangles[kTriangles];
  [[unroll]] for (uint k = 0u; k < kTriangles; ++k) triangles[k] = loadTriangle(min(first + k * kDrawGroup, end - 1u));

  uint vpls = min(steps.words[kListWords * kStepLists * step_ + 3u] - gl_WorkGroupID.y * kBatch, kBatch);
  uvec4 covered = uvec4(0u), small = uvec4(0u);
  for (uint v = 0u; v < vpls; ++v) {
    VplView view = views.list[gl_WorkGroupID.y * kBatch + v];
    // Without branches, as on a CPU device both sides of a branch run.
    [[unroll]] for (uint k = 0u; k < kTriangles; ++k) {
      vec3 a = seenFrom(view, triangles[k].a), b = seenFrom(view, triangles[k].b), c = seenFrom(view, triangles[k].c);
      bool tight;
      TexelBox box = projectedBox(a, b, c, float(size), tight);
      bool above = max(max(a.z, b.z), c.z) > 0.0;
      covered[k] |= above && !(tight && isEmpty(box)) ? 1u << v : 0u;
      small[k] |= tight && texelCount(box) <= float(kSmallTexels) ? 1u << v : 0u;
    }
  }

  uvec3 pairs = uvec3(0u);
  [[unroll]] for (uint k = 0u; k < kTriangles; ++k) {
    uint index = first + k * kDrawGroup;
    if (index >= end) covered[k] = 0u;
    bool masked = alphaMask != 0u && isMasked(min(index, end - 1u));
    uint larges = covered[k] & ~small[k];
    small[k] &= covered[k];
    pairs += masked ? uvec3(0u, 0u, bitCount(covered[k])) : uvec3(bitCount(small[k]), bitCount(larges), 0u);
    if (larges != 0u) append(index, larges, true, masked);
    if (masked && small[k] != 0u) append(index, small[k], false, masked);
    if (masked) small[k] = 0u;
  }
  pairs = subgroupAdd(pairs);
  if (subgroupElect()) {
    atomicAdd(counters.small, pairs.x);
    atomicAdd(counters.large, pairs.y);
    atomicAdd(counters.masked, pairs.z);
  }

  while (small != uvec4(0u)) {
    uint k = small.x != 0u ? 0u : small.y != 0u ? 1u : small.z != 0u ? 2u : 3u;
    uint index = first + k * kDrawGroup, v = uint(findLSB(small[k]));
    small[k] &= small[k] - 1u;
    Pair pair = pairOf(views.list[gl_WorkGroupID.y * kBatch + v], loadTriangle(index), index, size, planeEpsilon, false
#ifdef MOVER_SLACK
                       , moverSlack
#endif
    );
    drawBox(pair, size);
  }
}
