// One work group: which slots get a new map in this frame, and the indirect dispatches that draw these maps. New VPLs
// always get one; of those kept from the previous frame, as many as the budget allows (passes/README.md, shadow-atlas).
// Defines: HAS_STATE 0/1: without the state of the
// VPLs every lit slot is drawn; REFRESH: 1 top, 2 split, 3 stale; STATIC_MAPS 0/1; CHANGE 0/1: whether changes of the
// light are known.
#include "vpls/paraboloid.glsl"
#include "vpls/vpl.glsl"
#include "shadow-atlas/step.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer VplsBlock { Vpl list[]; } vpls;
layout(std430) buffer RefreshedBlock { uint frames[]; } refreshed;  // number of the frame + 1, 0 if there is no map
layout(std430) buffer ChosenBlock { uint list[]; } chosen;
layout(std430) writeonly buffer ViewsBlock { VplView list[]; } views;
layout(std430) writeonly buffer StepsBlock { Step list[]; } steps;
layout(std430) buffer CountersBlock {
  uint maps, small, large, masked, fresh, refreshes, texels, unchanged, overlaid;
} counters;
#if HAS_STATE
layout(std430) readonly buffer ChangesBlock { uint list[]; } changes;
layout(std430) readonly buffer StateBlock { VplState list[]; } state;
#endif
#if CHANGE
uniform samplerBuffer change;  // z: share of what was known of the light that is lost
#endif

layout(push_constant) uniform Constants {
  uint slots;
  uint frameNumber;
  uint size;
  uint rounds;
  uint ranges;         // steps per round, one for each range of triangles
  uint allRanges;      // the first of them, for maps that are drawn from scratch
  uint allGroups;      // groups of the largest of those
  uint overlayGroups;  // groups of the largest of the others, which every map gets
  uint slices;         // of the work on large pairs
#if HAS_STATE
  float refreshShare;
  vec4 movers;  // xyz: centre, w: radius of a sphere around all moving objects, negative if there are none
#endif
};

#include "shadow-atlas/compact.glsl"

#if HAS_STATE
// Where a door opens, maps that still show it hide the light that has come in.
#if CHANGE
float shareDrawn() { return max(refreshShare, texelFetch(change, 0).z); }
#else
float shareDrawn() { return refreshShare; }
#endif

shared uint histogram[256];
shared uint threshold, takenAbove;

const uint kByImportance = 0u, kByStaleness = 1u, kByUrgency = 2u;
const float kLeastImportance = 0.05;  // so that unimportant maps are refreshed too

// Priority among the maps that may be drawn again; 0 if it is not one of them.
uint priority(uint slot, uint order) {
  if (chosen.list[slot] != kSlotKept) return 0u;
  float importance = max(state.list[slot].importance, 0.0);
  if (order == kByImportance) return floatBitsToUint(importance) + 1u;
  uint age = min(frameNumber + 1u - refreshed.frames[slot], 0x3fffffffu);  // frames since it was drawn
  if (order == kByUrgency)
    return changes.list[slot] == kChangeNone ? 0u : floatBitsToUint((importance + kLeastImportance) * float(age));
  // Four times as urgent if something moves in front of the VPL.
  Vpl v = vpls.list[slot];
  bool sees = movers.w >= 0.0 && dot(v.normal, movers.xyz - v.position) > -movers.w;
  return (sees ? 4u : 1u) * age;
}

// Marks the `budget` slots of the highest priority, ties by slot: a radix search for the least priority that is taken.
void take(uint budget, uint order) {
  uint i = gl_LocalInvocationIndex;
  if (i == 0u) {
    threshold = 0u;
    takenAbove = 0u;
  }
  for (int shift = 24; shift >= 0; shift -= 8) {
    histogram[i] = 0u;
    barrier();
    for (uint slot = i; slot < slots; slot += 256u) {
      uint key = priority(slot, order);
      // All higher digits must equal those of the threshold; a shift by 32 is undefined.
      bool inPrefix = shift == 24 || key >> (shift + 8) == threshold >> (shift + 8);
      if (key != 0u && inPrefix) atomicAdd(histogram[key >> shift & 255u], 1u);
    }
    barrier();
    if (i == 0u) {
      uint digit = 255u, above = takenAbove;
      while (digit > 0u && above + histogram[digit] < budget) above += histogram[digit--];
      threshold |= digit << shift;
      takenAbove = above;
    }
    barrier();
  }
  uint ties = budget - min(takenAbove, budget), seen = 0u;
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + i, key = slot < slots ? priority(slot, order) : 0u, total;
    bool tie = key != 0u && key == threshold;
    uint place = seen + compact(tie, total);
    if (key != 0u && (key > threshold || tie && place < ties)) chosen.list[slot] = kSlotRefreshed;
    seen += total;
  }
  memoryBarrierBuffer();
  barrier();
}
#endif

void chooseSlots() {
  uint i = gl_LocalInvocationIndex, kept = 0u, drawn = 0u, fresh = 0u;
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + i, total;
    uint choice = kSlotIdle;
    if (slot < slots) {
      bool lit = isLit(vpls.list[slot]);
#if HAS_STATE
      bool isNew = state.list[slot].life <= 1.0 || refreshed.frames[slot] == 0u;
#else
      const bool isNew = true;
#endif
      if (lit) choice = isNew ? kSlotNew : kSlotKept;
      else if (refreshed.frames[slot] != 0u) choice = kSlotEmptied;
      chosen.list[slot] = choice;
    }
    compact(choice == kSlotKept, total);
    kept += total;
  }
  memoryBarrierBuffer();
  barrier();
#if HAS_STATE
  uint budget = min(uint(ceil(shareDrawn() * float(kept))), kept);
#if REFRESH == 2
  uint first = (budget + 1u) / 2u;
  take(first, kByImportance);
  if (budget > first) take(budget - first, kByStaleness);
#else
  if (budget > 0u) take(budget, REFRESH == 3 ? kByUrgency : kByImportance);
#endif
#endif
  uint overlaid = 0u, unchanged = 0u;
  for (uint base = 0u; base < slots; base += 256u) {
    uint slot = base + i, total, choice = slot < slots ? chosen.list[slot] : kSlotIdle;
    if (choice == kSlotNew || choice == kSlotRefreshed) refreshed.frames[slot] = frameNumber + 1u;
    else if (choice == kSlotEmptied) refreshed.frames[slot] = 0u;
#if HAS_STATE
    uint change = slot < slots ? changes.list[slot] : kChangeNone;
    bool same = choice == kSlotRefreshed && change == kChangeNone;
    bool overlay = STATIC_MAPS != 0 && choice == kSlotRefreshed && change == kChangeMovers;
    if (same || overlay) chosen.list[slot] = choice = same ? kSlotKept : kSlotOverlaid;
    compact(same, total);
    unchanged += total;
    compact(overlay, total);
    overlaid += total;
#endif
    compact(isDrawn(choice), total);
    drawn += total;
    compact(choice == kSlotNew, total);
    fresh += total;
  }
  if (i == 0u) {
    counters.maps = drawn;
    counters.fresh = fresh;
    counters.refreshes = drawn - fresh;
    counters.texels = drawn * size * size;
    counters.unchanged = unchanged;
    counters.overlaid = overlaid;
  }
}

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

// Packs the VPLs whose maps are to be drawn, in the order of their slots, those that need only the moving triangles last,
// and prepares the indirect dispatches of the steps.
void prepareSteps() {
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

void main() {
  chooseSlots();
  memoryBarrierBuffer();
  barrier();
  prepareSteps();
}
