// Records the kernels of the shadow atlas exchange: a batch of VPLs and the work of one step.
#ifndef FOVEA_SHADOW_ATLAS_STEP_GLSL
#define FOVEA_SHADOW_ATLAS_STEP_GLSL

const uint kBatch = BATCH;        // VPLs that share one reading of a triangle: their records are read from a uniform buffer
const uint kTriangleBits = 27u;  // a pair is one word: VPL of the batch << kTriangleBits | triangle
const uint kTriangleMask = (1u << kTriangleBits) - 1u;

// What happens to a slot in this frame.
const uint kSlotIdle = 0u;       // it is empty and has been
const uint kSlotKept = 1u;       // its map stays as it is
const uint kSlotNew = 2u;        // drawn: there is no map of this VPL
const uint kSlotRefreshed = 3u;  // drawn again
const uint kSlotEmptied = 4u;    // its VPL has gone
const uint kSlotOverlaid = 5u;   // drawn again: what moves, over the map that is kept of what never does

bool isDrawn(uint choice) { return choice == kSlotNew || choice == kSlotRefreshed || choice == kSlotOverlaid; }

// What would be different in a map if it were drawn again.
const uint kChangeNone = 0u;
const uint kChangeMovers = 1u;
const uint kChangeAll = 2u;  // the VPL has moved, or there is no map

#ifdef MOVERS
struct DrawnMap {  // what a map was drawn with
  vec4 position, normal;
  vec4 movers[MOVERS];  // xyz: centre, w: radius of a sphere around dynamic objects; below 0: unused
  uint poses[MOVERS];   // the same as long as those keep their pose
};
#endif

struct VplView {
  vec4 positionSlot;  // xyz: world space, m; w: slot of the atlas
  vec4 tangent;       // the VPL's frame; all 0 in an unused record, which then sees nothing
  vec4 bitangent;
  vec4 normal;
};

// Arguments of an indirect dispatch, and how many pairs it works on. Dispatches are folded into rows, since a
// dimension ends at 65,535 groups.
struct WorkList {
  uint x, y, z;
  uint count;
};
const uint kGroupsPerRow = 4096u;

// Work on one batch over a range of triangles. A pair is in one of the four lists.
struct Step {
  WorkList cull;
  WorkList small;  // boxes of up to kSmallTexels: an invocation a pair
  WorkList large;  // eight invocations a pair
  WorkList maskedSmall, maskedLarge;  // likewise, where the material has holes
};
const uint kListWords = 4u, kStepWords = 20u;  // sizes of WorkList and Step
const uint kSmallTexels = 64u;
const uint kSmallPerGroup = 64u;
const uint kLargePerGroup = 8u;

// Where entry i of a list stands in the buffer of pairs: two arrays, each as long as all pairs of a step,
// opaque and masked; small ones from the front, large ones from the back.
uint smallPlace(uint i, uint capacity, bool masked) { return masked ? capacity + i : i; }
uint largePlace(uint i, uint capacity, bool masked) { return (masked ? 2u * capacity : capacity) - 1u - i; }

#endif
