#extension GL_EXT_control_flow_attributes : require
// First of two steps: finds the texels that each triangle may cover in the maps of a batch of VPLs and lists the
// pairs to rasterise. One triangle per invocation, read once for the whole batch.
#include "vpls/paraboloid.glsl"
#include "shadow-atlas/project.glsl"
#include "shadow-atlas/step.glsl"
#include "shadow-atlas/triangles.glsl"

layout(local_size_x = kCullGroup) in;

layout(std140) uniform BatchBlock { VplView views[kBatch]; } batch;
layout(std430) buffer StepsBlock { uint words[]; } steps;  // Step
layout(std430) writeonly buffer PairsBlock { uint list[]; } pairs;

layout(push_constant) uniform Constants {
  uint step_;
  uint firstTriangle;
  uint triangleCount;
  uint capacity;  // all pairs of a step
  uint size;
  uint alphaMask;
};

// Adds a pair to one of the four lists. A single atomic serves all lists, since a CPU device runs every branch.
void append(uint pair, uint large, uint masked) {
  uint list = kStepWords * step_ + kListWords * (1u + large + 2u * masked);  // step_'s WorkList
  uint entry = atomicAdd(steps.words[list + 3u], 1u);
  pairs.list[large != 0u ? largePlace(entry, capacity, masked != 0u) : smallPlace(entry, capacity, masked != 0u)] =
      pair;
  // The first entry of each group adds a group to the indirect dispatch.
  uint perGroup = large != 0u ? kLargePerGroup : kSmallPerGroup, group = entry / perGroup;
  bool inFirstRow = group < kGroupsPerRow;
  if (entry % perGroup == 0u && (inFirstRow || group % kGroupsPerRow == 0u))
    atomicAdd(steps.words[list + (inFirstRow ? 0u : 1u)], 1u);
}

void main() {
  if (gl_GlobalInvocationID.x >= triangleCount) return;
  uint index = firstTriangle + gl_GlobalInvocationID.x;
  Triangle triangle = loadTriangle(index);
  uint masked = alphaMask != 0u && isMasked(index) ? 1u : 0u;

  // Branch-free code over an unrolled batch. On a CPU device both sides of a branch run, and records at constant
  // places of a uniform buffer are read once for all lanes.
  uint covered = 0u, large = 0u;
  [[unroll]] for (uint v = 0u; v < kBatch; ++v) {
    vec3 a = seenFrom(batch.views[v], triangle.a);
    vec3 b = seenFrom(batch.views[v], triangle.b);
    vec3 c = seenFrom(batch.views[v], triangle.c);
    bool tight;
    TexelBox box = projectedBox(a, b, c, float(size), tight);
    bool above = max(max(a.z, b.z), c.z) > 0.0;
    covered |= above && !(tight && isEmpty(box)) ? 1u << v : 0u;
    large |= tight && texelCount(box) <= float(kSmallTexels) ? 0u : 1u << v;
  }

  do {
    if (covered != 0u) {
      uint v = uint(findLSB(covered));
      append(v << kTriangleBits | index, large >> v & 1u, masked);
      covered &= covered - 1u;
    }
  } while (covered != 0u);
}
