// Records and constants of the passes vpl-intensity-*.
#pragma once

#include "../../shaders/records/shared.h"

SHARED_BEGIN(fovea::passes::intensity)

// Sums over the scene and the lists. Areas are 64-bit integers (low, high word) in units of 1 / kAreaUnits cell
// faces, as integers add up to the same sum in any order.
struct Totals {
  uint alive SHARED_ZERO;    // slots that hold a VPL
  uint found SHARED_ZERO;    // eye paths that hit a surface, see escapes.comp, share.comp
  uint areaLow SHARED_ZERO;  // surface of all voxel sides
  uint areaHigh SHARED_ZERO;
};
SHARED_SIZE(Totals, 16)

// What is kept from frame to frame.
struct Kept {
  float total SHARED_ZERO;   // area of `constant`, m^2, 0 if not known yet
  float median SHARED_ZERO;  // latest median of the densities, 1/m^2
};
SHARED_SIZE(Kept, 8)

// A VPL to which surface or paths may be assigned.
struct VplSite {
  vec3 position SHARED_ZERO;
  // Strategy `area`: 1 if the VPL competes, else 0. Strategy `importance-area`: added to its distance, m^2; for one
  // that the region hardly sees it is kThinSite minus that; -1 means that it takes no paths.
  float handicap SHARED_ZERO;
  vec3 normal SHARED_ZERO;
  float light SHARED_ZERO;  // luminance of its side, negative if the side is emissive
};
SHARED_SIZE(VplSite, 32)

// The end of a path through the voxels.
struct PathEnd {
  vec3 position SHARED_ZERO;
  float kind SHARED_ZERO;  // siteKind(); 0 if the path hits nothing
  vec3 normal SHARED_ZERO;
  float luminance SHARED_ZERO;
};
SHARED_SIZE(PathEnd, 32)

// Paths assigned to a VPL, in parts of a path, and their light: in lightX as lightUnits(), for traced paths
// rgb in their unit.
struct PathSum {
  uint paths SHARED_ZERO;
  uint lightX SHARED_ZERO;
  uint lightY SHARED_ZERO;
  uint lightZ SHARED_ZERO;
};
SHARED_SIZE(PathSum, 16)

// Cells along the edge of a brick. Rays cross empty bricks in one step; the sides in a brick share one list of the
// VPLs that can be nearest to any of them.
SHARED_CONSTANT int kBrick = 4;

SHARED_END
