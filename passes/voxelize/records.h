// Constants and records of pass voxelize.
#pragma once

#include "../../shaders/records/shared.h"

SHARED_BEGIN(fovea::passes::voxelize)

SHARED_CONSTANT uint kSmallColumns = 16u;   // a triangle with more columns of cells is split into chunks
SHARED_CONSTANT uint kChunkColumns = 256u;  // of this many columns, one work group each
SHARED_CONSTANT uint kSumWords = 30u;       // of one side, see visit.glsl
SHARED_CONSTANT uint kTriangleBits = 22u;   // bits for the largest piece of an object that deforms
// Weight of an emissive surface in the position and normal of a side; others weigh 1. A VPL stands at that position,
// and the light of a lamp must not start inside the fitting or ceiling behind it.
SHARED_CONSTANT float kEmissiveWeight = 256.0f;
SHARED_CONSTANT uint kRow = 32768u;      // work groups in a row of a dispatch
SHARED_CONSTANT uint kScanBlock = 256u;  // words per work group of a prefix sum

struct Phase {     // 0: static triangles, 1: dynamic ones
  uint groups[3];  // indirect dispatch: one invocation per side of the phase's voxels, 64 in a group
  uint voxels;     // for which there was room
  uint first;      // number of the first of them
  uint overflow;
  uint unused0, unused1;
};
SHARED_SIZE(Phase, 32)

struct State {
  uint chunkGroups[3];  // indirect dispatch: one work group per chunk
  uint chunks;
  Phase phases[2];
};
SHARED_SIZE(State, 80)
SHARED_OFFSET(State, phases, 16)

SHARED_END
