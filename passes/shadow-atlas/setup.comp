// One work group: packs the VPLs whose maps are to be drawn into batches, in the order of their slots, and prepares
// the indirect dispatches of the steps. VPLs that need only the moving triangles follow in batches of their own.
#include "vpls/paraboloid.glsl"
#include "vpls/vpl.glsl"
#include "shadow-atlas/step.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) writeonly buffer BatchBlock { VplView views[]; } batch;
layout(std430) writeonly buffer StepsBlock { Step list[]; } steps;
layout(std430) readonly buffer ChosenBlock { uint list[]; } chosen;

layout(push_constant) uniform Constants {
  uint slots;
  uint batches;
  uint ranges;         // steps per batch, one for each range of triangles
  uint allRanges;      // the first of them, for maps that are drawn from scratch
  uint allGroups;      // groups of the largest of those
  uint overlayGroups;  // groups of the largest of the others, which every map gets
};

#include "shadow-atlas/compact.glsl"

// Packs the slots with or without `overlaid` from place `count` on and leaves the rest of the last batch
// empty. Returns the end.
uint pack(bool overlaid, uint count) {
  uint i = gl_LocalInvocationIndex;
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + i;
    uint choice = slot < slots ? chosen.list[slot] : kSlotIdle;
    bool draw = isDrawn(choice) && (choice == kSlotOverlaid) == overlaid;
    uint total;
    uint place = count + compact(draw, total);
    if (draw) {
      Vpl v = vpls.list[slot];
      mat3 frame = orthonormalFrame(v.normal);
      batch.views[place] = VplView(v.position, slot, frame[0], 0.0, frame[1], 0.0, frame[2], 0.0);
    }
    count += total;
  }
  uint end = (count + kBatch - 1u) / kBatch * kBatch;
  for (uint place = count + i; place < end; place += 256u)
    batch.views[place] = VplView(vec3(0.0), 0u, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
  return end;
}

void main() {
  uint whole = pack(false, 0u) / kBatch, all = pack(true, whole * kBatch) / kBatch;
  WorkList none = WorkList(0u, 1u, 1u, 0u);
  for (uint s = gl_LocalInvocationIndex; s < batches * ranges; s += 256u) {
    bool overlay = s % ranges >= allRanges;
    uint groups = s / ranges < (overlay ? all : whole) ? (overlay ? overlayGroups : allGroups) : 0u;
    steps.list[s] = Step(WorkList(groups, 1u, 1u, 0u), none, none, none, none);
  }
}
