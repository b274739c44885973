// How far pass `emit` has come with the light paths of a frame.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// Keeps the random numbers of light paths apart from others.
SHARED_CONSTANT uint kLightPathStream = 0x656d6974u;

// Paths are traced in rounds. A path counts once it is known that its VPLs and those of all before it fit into the
// list.
struct LightPaths {
  uint groupsX SHARED_ZERO;  // work groups of the next round
  uint groupsY SHARED_ZERO;
  uint groupsZ SHARED_ZERO;
  uint first SHARED_ZERO;        // of the paths of the next round,
  uint count SHARED_ZERO;        // and how many these are
  uint paths SHARED_ZERO;        // that count
  uint stored SHARED_ZERO;       // their VPLs
  uint full SHARED_ZERO;         // 1 after a path that no longer fits
  uint bounces SHARED_ZERO;      // most hits of a path
  float lightPower SHARED_ZERO;  // of the scene's lights, mean of the channels, W
  float power SHARED_ZERO;       // and of emissive triangles
  uint unused SHARED_ZERO;
};
SHARED_SIZE(LightPaths, 48)

// A round has as many columns of work groups as one dimension of a dispatch surely may, and fewer rows.
SHARED_CONSTANT uint kLightPathGroup = 64u, kLightPathColumns = 1024u;
// Paths tried for each VPL of the list, and beside that, before giving up on a scene that its lights do not reach.
SHARED_CONSTANT uint kPathsPerVpl = 256u, kPathsBeside = 4096u;

SHARED_END
