#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
// First of two: finds the texels each triangle may cover in the maps of a batch of VPLs and lists the pairs
// worth rasterising. One triangle an invocation, read once for the whole batch.
#include "common/paraboloid.glsl"
#include "shadow-atlas/project.glsl"
#include "shadow-atlas/step.glsl"
#include "shadow-atlas/triangles.glsl"

layout(local_size_x = 128) in;

layout(set = 0, std140) uniform BatchBlock { VplView views[BATCH]; } batch;
layout(set = 0, std430) buffer StepsBlock { uint words[]; } steps;  // Step
layout(set = 0, std430) writeonly buffer PairsBlock { uint list[]; } pairs;

layout(push_constant) uniform Constants {
  uint step_;
  uint firstTriangle;
  uint triangleCount;
  uint capacity;  // all pairs of a step
  uint size;
  uint alphaMask;
};

// Adds a pair to one of the lists. One atomic whatever the list, since a CPU device runs every branch.
void append(uint pair, uint list) {
  uint words = kStepWords * step_ + kListWords * (1u + list);  // step_'s WorkList
  uint entry = atomicAdd(steps.words[words + 3u], 1u);
  pairs.list[pairPlace(list, entry, capacity)] = pair;
  // The indirect dispatch gets another group with a group's first entry.
  bool large = list == kLarge || list == kMaskedLarge;
  uint perGroup = large ? kLargePerGroup : kSmallPerGroup, group = entry / perGroup;
  bool inFirstRow = group < kGroupsPerRow;
  if (entry % perGroup == 0u && (inFirstRow || group % kGroupsPerRow == 0u))
    atomicAdd(steps.words[words + (inFirstRow ? 0u : 1u)], 1u);
}

void main() {
  if (gl_GlobalInvocationID.x >= triangleCount) return;
  uint index = firstTriangle + gl_GlobalInvocationID.x;
  Triangle triangle = loadTriangle(index);
  bool masked = alphaMask != 0u && isMasked(index);

  // Straight code over a batch unrolled: on a CPU device both sides of a branch run, and records at constant
  // places of a uniform buffer are read once for all lanes.
  uint covered = 0u, tiny = 0u, large = 0u;
  [[unroll]] for (uint v = 0u; v < kBatch; ++v) {
    vec3 a = seenFrom(batch.views[v], triangle.a);
    vec3 b = seenFrom(batch.views[v], triangle.b);
    vec3 c = seenFrom(batch.views[v], triangle.c);
    bool tight;
    TexelBox box = projectedBox(a, b, c, float(size), tight);
    bool above = max(max(a.z, b.z), c.z) > 0.0;
    covered |= above && !(tight && isEmpty(box)) ? 1u << v : 0u;
    float texels = tight ? texelCount(box) : 1e9;
    tiny |= texels <= float(kTinyTexels) ? 1u << v : 0u;
    large |= texels > float(kSmallTexels) ? 1u << v : 0u;
  }

  do {
    if (covered != 0u) {
      uint v = uint(findLSB(covered));
      uint isLarge = large >> v & 1u, isTiny = tiny >> v & 1u;
      append(v << kTriangleBits | index, masked ? kMaskedSmall + isLarge : kSmall + isLarge - isTiny);
      covered &= covered - 1u;
    }
  } while (covered != 0u);
}
