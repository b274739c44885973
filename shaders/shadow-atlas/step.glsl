// Records the kernels of the shadow atlas exchange: a batch of VPLs and the work of one step.
#ifndef FOVEA_SHADOW_ATLAS_STEP_GLSL
#define FOVEA_SHADOW_ATLAS_STEP_GLSL

const uint kBatch = BATCH;      // VPLs that share one reading of a triangle: their records are read from a uniform buffer
const uint kTriangleBits = 27u;  // a pair is one word: VPL of the batch << kTriangleBits | triangle

struct VplView {
  vec4 positionSlot;  // xyz: world space, m; w: slot of the atlas
  vec4 tangent;       // the VPL's frame; all 0 in an unused record, which then sees nothing
  vec4 bitangent;
  vec4 normal;
};

// Work of one step (a batch over a range of triangles): arguments of indirect dispatches, and the lists' lengths.
struct Step {
  uint cullX, cullY, cullZ, unused;
  uint smallX, smallY, smallZ, smallCount;
  uint largeX, largeY, largeZ, largeCount;
  uint maskedX, maskedY, maskedZ, maskedCount;
};

const uint kTriangleMask = (1u << kTriangleBits) - 1u;
#ifndef SMALL_TEXELS
#define SMALL_TEXELS 16u
#endif
const uint kSmallTexels = SMALL_TEXELS;  // the largest box of a small pair; larger ones get eight invocations
const uint kSmallPerGroup = 64u;
const uint kLargePerGroup = 8u;
const uint kGroupsPerRow = 4096u;  // indirect dispatches are folded into rows: a dimension ends at 65,535 groups

#endif
