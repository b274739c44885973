#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
// First of two: finds the texels each triangle may cover in the maps of a batch of VPLs and lists the pairs worth
// rasterising. One triangle an invocation, read once for the whole batch.
#include "common/paraboloid.glsl"
#include "shadow-atlas/project.glsl"
#include "shadow-atlas/step.glsl"
#include "shadow-atlas/triangles.glsl"

layout(local_size_x = 128) in;

layout(set = 0, std140) uniform BatchBlock { VplView views[BATCH]; } batch;
layout(set = 0, std430) buffer StepsBlock { Step list[]; } steps;
layout(set = 0, std430) writeonly buffer PairsBlock { uint list[]; } pairs;

layout(push_constant) uniform Constants {
  uint step_;
  uint firstTriangle;
  uint triangleCount;
  uint capacity;  // pairs of one list; small ones stand at its front, large ones at its back, masked ones in a second list
  uint size;
  uint alphaMask;
};

// Group g of an indirect dispatch comes into being with its first entry.
#define COUNT_GROUP(kind, entry, perGroup)                                                              \
  if ((entry) % (perGroup) == 0u) {                                                                      \
    uint group = (entry) / (perGroup);                                                                   \
    if (group < kGroupsPerRow) atomicAdd(steps.list[step_].kind##X, 1u);                                 \
    else if (group % kGroupsPerRow == 0u) atomicAdd(steps.list[step_].kind##Y, 1u);                      \
  }

void append(uint pair, bool large, bool masked) {
  if (masked) {
    uint entry = atomicAdd(steps.list[step_].maskedCount, 1u);
    pairs.list[capacity + entry] = pair;
    COUNT_GROUP(masked, entry, kLargePerGroup)
  } else if (large) {
    uint entry = atomicAdd(steps.list[step_].largeCount, 1u);
    pairs.list[capacity - 1u - entry] = pair;
    COUNT_GROUP(large, entry, kLargePerGroup)
  } else {
    uint entry = atomicAdd(steps.list[step_].smallCount, 1u);
    pairs.list[entry] = pair;
    COUNT_GROUP(small, entry, kSmallPerGroup)
  }
}

void main() {
  if (gl_GlobalInvocationID.x >= triangleCount) return;
  uint index = firstTriangle + gl_GlobalInvocationID.x;
  Triangle triangle = loadTriangle(index);
  bool masked = alphaMask != 0u && isMasked(index);

  // Straight code over a batch unrolled: on a CPU device both sides of a branch run, and records at constant places of
  // a uniform buffer are read once for all lanes.
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
      append(v << kTriangleBits | index, (large >> v & 1u) != 0u, masked);
      covered &= covered - 1u;
    }
  } while (covered != 0u);
}
