// The cells in which passes remember the light that rays have gathered (rays/gather_cache.glsl).
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// A place in the table of cells.
struct GatherCell {
  vec3 light SHARED_ZERO;    // mean radiance over the hemisphere, W/(sr m^2)
  float weight SHARED_ZERO;  // number of samples that the mean is worth
  uint key SHARED_ZERO;      // of the cell that is here, 0 if none is
  uint idle SHARED_ZERO;     // frames since the last sample
  // Samples of this frame, and the sums of their channels in 2^-32 W/(sr m^2), as pairs of low and high words. Whole
  // numbers have the same sum in any order.
  uint samples SHARED_ZERO;
  uint red SHARED_ZERO;
  uint redHigh SHARED_ZERO;
  uint green SHARED_ZERO;
  uint greenHigh SHARED_ZERO;
  uint blue SHARED_ZERO;
  uint blueHigh SHARED_ZERO;
  uint unused0 SHARED_ZERO;
  uint unused1 SHARED_ZERO;
  uint unused2 SHARED_ZERO;
};
SHARED_SIZE(GatherCell, 64)

SHARED_CONSTANT uint kGatherCells = 131072u;  // places in the table
SHARED_CONSTANT uint kGatherPlaces = 16u;     // of them in which a cell may be
SHARED_CONSTANT uint kMostIdle = 64u;         // frames without a sample after which a cell leaves the table

SHARED_CONSTANT float kEnoughGathered = 16.0f;  // samples from which on a cell is known
SHARED_CONSTANT float kMostGathered = 256.0f;   // a cell's mean is worth no more samples: old ones fade
// W/(sr m^2): brighter samples are cut off, so that the sum of 4096 of them in a frame fits into its words.
SHARED_CONSTANT float kMostGatheredLight = 1048576.0f;
SHARED_CONSTANT float kGatheredAnew = 0.25f;  // probability of gathering anew what is known
// Keeps the random numbers with which cells are looked up apart from others.
SHARED_CONSTANT uint kCellStream = 0x6e656363u;

SHARED_END
