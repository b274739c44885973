// One work group: packs the VPLs whose maps are to be drawn, in the order of their slots, and prepares the indirect
// dispatches of the steps. VPLs that need only the moving triangles come last.
#include "vpls/paraboloid.glsl"
#include "vpls/vpl.glsl"
#include "shadow-atlas/step.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) writeonly buffer ViewsBlock { VplView list[]; } views;
layout(std430) writeonly buffer StepsBlock { Step list[]; } steps;
layout(std430) readonly buffer ChosenBlock { uint list[]; } chosen;

layout(push_constant) uniform Constants {
  uint slots;
  uint rounds;
  uint ranges;         // steps per round, one for each range of triangles
  uint allRanges;      // the first of them, for maps that are drawn from scratch
  uint allGroups;      // groups of the largest of those
  uint overlayGroups;  // groups of the largest of the others, which every map gets
  uint slices;         // of the work on large pairs
};

#include "shadow-atlas/compact.glsl"

// Packs the slots with or without `overlaid` from place `count` on. Returns the end.
uint pack(bool overlaid, uint count) {
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + gl_LocalInvocationIndex;
    uint choice = slot < slots ? chosen.list[slot] : kSlotIdle;
    bool draw = isDrawn(choice) && (choice == kSlotOverlaid) == overlaid;
    uint total;
    uint place = count + compact(draw, total);
    if (draw) {
      Vpl v = vpls.list[slot];
      mat3 frame = orthonormalFrame(v.normal);
      views.list[place] = VplView(v.position, slot, frame[0], 0.0, frame[1], 0.0, frame[2], 0.0);
    }
    count += total;
  }
  return count;
}

void main() {
  uint whole = pack(false, 0u), all = pack(true, whole);
  for (uint s = gl_LocalInvocationIndex; s < rounds * ranges; s += 256u) {
    bool overlay = s % ranges >= allRanges;
    WorkList large = WorkList(0u, 1u, slices, 0u);
    uint end = overlay ? all : whole, first = s / ranges * kRound;
    uint count = min(end - min(first, end), kRound), batches = (count + kBatch - 1u) / kBatch;
    steps.list[s] = Step(WorkList(overlay ? overlayGroups : allGroups, batches, 1u, count),
                         large, WorkList(0u, 1u, 1u, 0u), large);
  }
}
