#version 460
#extension GL_GOOGLE_include_directive : require
// One work group: packs the VPLs whose maps are to be drawn, in the order of their slots, into batches, and
// prepares the steps' indirect dispatches.
#include "common/paraboloid.glsl"
#include "common/vpl.glsl"
#include "shadow-atlas/step.glsl"

layout(local_size_x = 256) in;

layout(set = 0, std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(set = 0, std430) writeonly buffer BatchBlock { VplView views[]; } batch;
layout(set = 0, std430) writeonly buffer StepsBlock { Step list[]; } steps;
layout(set = 0, std430) buffer CountersBlock { uint maps, small, large, masked; } counters;

layout(push_constant) uniform Constants {
  uint slots;
  uint ranges;      // steps a batch: one for each range of triangles
  uint cullGroups;  // of the largest range
};

shared uint sums[256];

// Number of set flags before this invocation's, and in all.
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

void main() {
  uint i = gl_LocalInvocationIndex;
  uint count = 0u;
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + i;
    bool draw = slot < slots && any(notEqual(vpls.list[min(slot, slots - 1u)].intensity.rgb, vec3(0.0)));
    uint total;
    uint place = count + compact(draw, total);
    if (draw) {
      Vpl v = vpls.list[slot];
      mat3 frame = orthonormalFrame(v.normal.xyz);
      batch.views[place] = VplView(vec4(v.positionArea.xyz, float(slot)), vec4(frame[0], 0.0), vec4(frame[1], 0.0),
                                   vec4(frame[2], 0.0));
    }
    count += total;
  }
  uint padded = (slots + kBatch - 1u) / kBatch * kBatch;
  for (uint place = count + i; place < padded; place += 256u)
    batch.views[place] = VplView(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  WorkList none = WorkList(0u, 1u, 1u, 0u);
  uint batches = padded / kBatch;
  for (uint s = i; s < batches * ranges; s += 256u) {
    uint groups = (s / ranges) * kBatch < count ? cullGroups : 0u;
    steps.list[s] = Step(WorkList(groups, 1u, 1u, 0u), none, none, none, none);
  }
  if (i == 0u) counters.maps = count;
}
