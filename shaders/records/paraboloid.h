// Constants of the paraboloid maps of VPLs, and how they lie in the shadow atlas (vpls/paraboloid.glsl).
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

SHARED_CONSTANT uint kParaboloidEmpty = 0x7f800000u;  // the bits of +inf, where nothing is hit
SHARED_CONSTANT uint kAtlasTiles = 16u;               // maps per layer of an atlas in the layout `tiled`

// The layout follows from the size of the atlas: `height` texels per map, width / height maps side by side in a layer
// (a power of two; 1 in layout `layers`). Slot s is map s % perLayer of layer s / perLayer.
struct AtlasLayout {
  int size SHARED_ZERO;   // texels per side of a map
  int shift SHARED_ZERO;  // log2 of the maps in a layer
};

SHARED_END
