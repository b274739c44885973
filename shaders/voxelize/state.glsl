// State shared by the steps of one voxelisation. Must match passes/voxelize.
#ifndef FOVEA_VOXELIZE_STATE_GLSL
#define FOVEA_VOXELIZE_STATE_GLSL

const uint kSmallColumns = 16u;   // a triangle with more columns of cells is split into chunks
const uint kChunkColumns = 256u;  // of this many columns, one work group each
const uint kSumWords = 28u;       // of one side, see visit.glsl
const uint kTriangleBits = 22u;   // bits of the record of the largest piece of an object that deforms
const uint kRow = 32768u;         // work groups in a row of a dispatch
const uint kScanBlock = 256u;     // words per work group of a prefix sum

struct Phase {     // 0: static triangles, 1: dynamic ones
  uint groups[3];  // indirect dispatch: one invocation per side of the phase's voxels, 64 in a group
  uint voxels;     // for which there was room
  uint first;      // number of the first of them
  uint overflow;
  uint unused0, unused1;
};
struct State {
  uint chunkGroups[3];  // indirect dispatch: one work group per chunk
  uint chunks;
  Phase phases[2];
};

uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

#endif
