// What the kernels of the shadow atlas tell each other.
#ifndef FOVEA_SHADOW_ATLAS_STEP_GLSL
#define FOVEA_SHADOW_ATLAS_STEP_GLSL

#include "shadow-atlas/records.h"

const uint kTriangleBits = 27u;  // of VplSet.triangle
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

const uint kListWords = 4u, kStepLists = 4u;  // sizes of WorkList and Step
const uint kSmallTexels = 64u;                // the most that a small pair's box has
const uint kSmallPerGroup = 64u;
const uint kLargePerGroup = 8u;

#endif
