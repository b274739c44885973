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
layout(set = 0, std430) readonly buffer ChosenBlock { uint list[]; } chosen;

layout(push_constant) uniform Constants {
  uint slots;
  uint ranges;      // steps a batch: one for each range of triangles
  uint cullGroups;  // of the largest range
};

#include "shadow-atlas/compact.glsl"

void main() {
  uint i = gl_LocalInvocationIndex;
  uint count = 0u;
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + i;
    uint choice = slot < slots ? chosen.list[slot] : kSlotIdle;
    bool draw = choice == kSlotNew || choice == kSlotRefreshed;
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
}
