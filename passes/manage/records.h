// Records and constants of pass manage.
#pragma once

#include "../../shaders/records/shared.h"

SHARED_BEGIN(fovea::passes::manage)

// Density grid of 64^3 cells that repeats in space. This is a hash without collisions inside the scene, whose longest
// edge is at most as long as 64 cells, and it has a place for VPLs outside.
SHARED_CONSTANT uint kCellBits = 18u;
SHARED_CONSTANT uint kCells = 1u << kCellBits;

struct ManageState {
  uint occupied SHARED_ZERO;        // cells that hold a VPL or a candidate
  uint alive SHARED_ZERO;           // VPLs at the start
  uint accepted SHARED_ZERO;        // number of those accepted by Eq. 1
  uint reused SHARED_ZERO;          // number of those in the new list
  uint oldCount SHARED_ZERO;        // |L'|
  uint candidateCount SHARED_ZERO;  // |Lc|
};
SHARED_SIZE(ManageState, 24)

struct SlotRecord {
  uint importance SHARED_ZERO;  // 24 bits
  uint flags SHARED_ZERO;
  uint cell SHARED_ZERO;  // of the density grid
  uint key SHARED_ZERO;   // 24 bits: VPLs with lower keys are reused first
};
SHARED_SIZE(SlotRecord, 16)

SHARED_END
