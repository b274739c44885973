// A grid of probes that hold the light and the distances around them: the bundles `probe-rays` and `probes`
// (shaders/probes).
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// Probes stand at the centres of cubic cells that cover the scene's bounds, x fastest.
struct ProbeGrid {
  vec3 origin SHARED_ZERO;          // centre of the first cell, world space, m
  float spacing SHARED_DEFAULT(1);  // width of a cell, m
  uint columns SHARED_DEFAULT(1);   // cells along x, y and z
  uint rows SHARED_DEFAULT(1);
  uint layers SHARED_DEFAULT(1);
  uint rays SHARED_ZERO;  // of each probe
};
SHARED_SIZE(ProbeGrid, 32)
SHARED_OFFSET(ProbeGrid, columns, 16)

// The state of a probe. All zeros stand for one that has just been put into its cell and knows nothing.
struct Probe {
  vec3 offset SHARED_ZERO;     // from the centre of its cell, m
  float frames SHARED_ZERO;    // for which it has stood there and gathered light
  float inside SHARED_ZERO;    // 1 if it is inside geometry: then nothing is lit by it
  float placings SHARED_ZERO;  // frames in which it might have moved
  float unused0 SHARED_ZERO;
  float unused1 SHARED_ZERO;
};
SHARED_SIZE(Probe, 32)
SHARED_OFFSET(Probe, inside, 16)

// A probe has a square tile in each of two images, in which directions lie in octahedral encoding. Around it is a
// border of one texel with what lies beyond the edges, so that the neighbours of a texel are found without leaving the
// tile.
SHARED_CONSTANT int kProbeTilesInARow = 64;
SHARED_CONSTANT int kIrradianceSide = 6;  // texels without the border
SHARED_CONSTANT int kDistanceSide = 14;

// Where rays hit the back of a surface, their distance is negative and shorter by this factor, so that such a probe
// lights less.
SHARED_CONSTANT float kBackShortened = 0.2f;
// Distances count up to this many diagonals of a cell.
SHARED_CONSTANT float kProbeReach = 1.5f;
// The mean over n frames gives the newest the weight of this many in n, until hysteresis limits it.
SHARED_CONSTANT float kSettling = 3.0f;
// A probe that is inside geometry traces every fourth of its rays, to find out when it no longer is.
SHARED_CONSTANT uint kInsideShare = 4u;
// Keep the random numbers of directions and of rays towards emitters apart from others.
SHARED_CONSTANT uint kProbeTurnStream = 0x70726f62u, kProbeEmitterStream = 0x70726f65u;

SHARED_END
