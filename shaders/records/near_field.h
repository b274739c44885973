// Constants of pass near-field, and what it keeps.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// Keep the random numbers of directions, of ranges, of what is gathered and of rays aimed at emitters apart.
SHARED_CONSTANT uint kNearStream = 0x6e656172u, kChoiceStream = 0x6e656368u, kNearGatherStream = 0x6e656774u,
                     kNearAimStream = 0x6e656169u;

SHARED_CONSTANT uint kItemsInGroup = 64u;   // entries of a list that a work group traces
SHARED_CONSTANT uint kMostGroups = 32768u;  // in a row of its dispatch

SHARED_CONSTANT float kClose = 2.0f;  // an emitter closer than so many widths of a wide block splits it
SHARED_CONSTANT float kLeastReceived = 0.05f;  // of a cosine that a bent normal replaces
SHARED_CONSTANT float kTileMiddleWeight =
    3.0f;  // of the tile in the middle of a row of three; the others have 1

SHARED_CONSTANT float kLengthKept = 0.875f;   // share of the mean ray length kept from frame to frame
SHARED_CONSTANT float kNearCellWidth = 0.1f;  // width of the cache's cells, in mean ray lengths

// Kept from frame to frame.
struct NearFieldState {
  float meanLength SHARED_ZERO;  // m, of the rays so far; 0 as long as none has met anything
  float area SHARED_ZERO;        // of a VPL's disc, m^2; 0: only the length is found
  float cellWidth SHARED_ZERO;   // of the cache's cells, m
  float ageing SHARED_ZERO;      // n samples of the cache are worth n / (1 + n ageing)
  uint foveaRays SHARED_ZERO;    // per sample in blocks of 2 x 2 pixels
};
SHARED_SIZE(NearFieldState, 20)

// Sums over the rays of a frame: 1 and the length in diagonals of the scene, each divided by the probability that the
// ray goes so far. Pairs of low and high words, in 2^-32. They are not part of the state, which all rays read while some
// add to these.
struct NearFieldSums {
  uint hits SHARED_ZERO;
  uint hitsHigh SHARED_ZERO;
  uint diagonals SHARED_ZERO;
  uint diagonalsHigh SHARED_ZERO;
};
SHARED_SIZE(NearFieldSums, 16)

// `spacing` x `spacing` pixels.
struct NearFieldTile {
  vec3 position SHARED_ZERO;  // of the surface from which the rays of a wide tile leave, world space, m
  uint narrow SHARED_ZERO;    // 1: divided into blocks of 2 x 2 pixels
  vec3 normal SHARED_ZERO;
  uint there SHARED_ZERO;  // 1: there is such a surface
};
SHARED_SIZE(NearFieldTile, 32)

SHARED_CONSTANT uint kWideItem =
    0x80000000u;  // in an item, beside the number of a tile: the sample is that of a wide tile, not of a texel

SHARED_END
