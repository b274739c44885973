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
  uint first SHARED_ZERO;        // number of the first path of the next round
  uint count SHARED_ZERO;        // how many paths the next round has
  uint paths SHARED_ZERO;        // how many paths count so far
  uint stored SHARED_ZERO;       // how many VPLs these have
  uint full SHARED_ZERO;         // 1 after a path whose VPLs no longer fit into the list
  uint bounces SHARED_ZERO;      // the most hits that a path may have
  float lightPower SHARED_ZERO;  // power of the scene's lights, mean of the channels, W
  float power SHARED_ZERO;       // that of lights and emissive triangles together, W
  uint unused SHARED_ZERO;
};
SHARED_SIZE(LightPaths, 48)

// A round has as many columns of work groups as one dimension of a dispatch surely may, and fewer rows.
SHARED_CONSTANT uint kLightPathGroup = 64u, kLightPathColumns = 1024u;
// Paths tried for each VPL of the list, and beside that, before giving up on a scene that its lights do not reach.
SHARED_CONSTANT uint kPathsPerVpl = 256u, kPathsBeside = 4096u;

SHARED_END
