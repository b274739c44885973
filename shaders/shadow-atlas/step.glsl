// Records exchanged by the kernels of the shadow atlas: a batch of VPLs and the work of one step.
#ifndef FOVEA_SHADOW_ATLAS_STEP_GLSL
#define FOVEA_SHADOW_ATLAS_STEP_GLSL

const uint kBatch = BATCH;        // VPLs that share one reading of a triangle; their records are in a uniform buffer
const uint kTriangleBits = 27u;  // a pair is one word: VPL of the batch << kTriangleBits | triangle
const uint kTriangleMask = (1u << kTriangleBits) - 1u;

// What is done with a slot in this frame.
const uint kSlotIdle = 0u;       // it is empty and was before
const uint kSlotKept = 1u;       // its map stays as it is
const uint kSlotNew = 2u;        // drawn, as its VPL has no map
const uint kSlotRefreshed = 3u;  // drawn again
const uint kSlotEmptied = 4u;    // cleared, as its VPL has gone
const uint kSlotOverlaid = 5u;   // drawn again: moving geometry over the kept map of static geometry

bool isDrawn(uint choice) { return choice == kSlotNew || choice == kSlotRefreshed || choice == kSlotOverlaid; }

// What would change in a map if it were drawn again.
const uint kChangeNone = 0u;
const uint kChangeMovers = 1u;
const uint kChangeAll = 2u;  // the VPL has moved, or has no map

#ifdef MOVERS
struct DrawnMap {  // the positions and poses with which a map was drawn
  vec4 position, normal;
  vec4 movers[MOVERS];  // xyz: centre, w: radius of a sphere around dynamic objects, negative if unused
  uint poses[MOVERS];   // unchanged as long as those keep their pose
};
#endif

struct VplView {
  vec4 positionSlot;  // xyz: world space, m; w: slot of the atlas
  vec4 tangent;       // the VPL's frame; all 0 in an unused record, which then sees nothing
  vec4 bitangent;
  vec4 normal;
};

// Arguments of an indirect dispatch, and the number of pairs it works on. Dispatches are folded into rows, since one
// dimension is limited to 65,535 groups.
struct WorkList {
  uint x, y, z;
  uint count;
};
const uint kGroupsPerRow = 4096u;

// Work on one batch over a range of triangles. Each pair is in one of the four lists.
struct Step {
  WorkList cull;
  WorkList small;  // boxes of up to kSmallTexels, one invocation per pair
  WorkList large;  // eight invocations per pair
  WorkList maskedSmall, maskedLarge;  // the same for materials with an alpha mask
};
const uint kListWords = 4u, kStepWords = 20u;  // sizes of WorkList and Step
const uint kSmallTexels = 64u;
const uint kSmallPerGroup = 64u;
const uint kLargePerGroup = 8u;

// Position of entry i of a list in the buffer of pairs. It has two arrays, opaque and masked, each as long as all
// pairs of a step; small pairs are stored from the front, large ones from the back.
uint smallPlace(uint i, uint capacity, bool masked) { return masked ? capacity + i : i; }
uint largePlace(uint i, uint capacity, bool masked) { return (masked ? 2u * capacity : capacity) - 1u - i; }

#endif
