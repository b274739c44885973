// Records and constants of pass shadow-atlas.
#pragma once

#include "../../shaders/records/shared.h"

SHARED_BEGIN(fovea::passes::atlas)

SHARED_CONSTANT uint kBatch = 32u;  // VPLs that share one reading of triangles
// VPLs that share dispatches; their records are in a uniform buffer.
SHARED_CONSTANT uint kRound = kBatch * 16u;
SHARED_CONSTANT uint kMovers = 4u;      // spheres around objects that may have changed a map (changed.comp)
SHARED_CONSTANT uint kDrawGroup = 64u;  // invocations per work group of draw.comp
SHARED_CONSTANT uint kTriangles = 4u;   // per invocation of draw.comp
// Dispatches are folded into rows, since one dimension is limited to 65,535 groups.
SHARED_CONSTANT uint kGroupsPerRow = 4096u;

// The positions and poses with which a map was drawn.
struct DrawnMap {
  vec3 position SHARED_ZERO;
  float unused0 SHARED_ZERO;
  vec3 normal SHARED_ZERO;
  float unused1 SHARED_ZERO;
  vec4 movers[kMovers];  // xyz: centre, w: radius of a sphere around dynamic objects, negative if unused
  uint poses[kMovers];   // unchanged as long as those keep their pose
};
SHARED_SIZE(DrawnMap, 32 + 20 * kMovers)
SHARED_OFFSET(DrawnMap, movers, 32)

struct VplView {
  vec3 position SHARED_ZERO;  // world space, m
  uint slot SHARED_ZERO;      // of the atlas
  vec3 tangent SHARED_ZERO;   // the VPL's frame
  float unused0 SHARED_ZERO;
  vec3 bitangent SHARED_ZERO;
  float unused1 SHARED_ZERO;
  vec3 normal SHARED_ZERO;
  float unused2 SHARED_ZERO;
};
SHARED_SIZE(VplView, 64)
SHARED_OFFSET(VplView, normal, 48)

// Arguments of an indirect dispatch, and the number of items it works on.
struct WorkList {
  uint x SHARED_ZERO;
  uint y SHARED_ZERO;
  uint z SHARED_ZERO;
  uint count SHARED_ZERO;
};
SHARED_SIZE(WorkList, 16)

// Work on the VPLs of a round over a range of triangles.
struct Step {
  WorkList draw;         // of draw.comp; counts VPLs, the others VplSets
  WorkList large;        // boxes of more than kSmallTexels: eight invocations per set
  WorkList maskedSmall;  // materials with an alpha mask, other boxes: one invocation per set
  WorkList maskedLarge;
};
SHARED_SIZE(Step, 64)

// A triangle, and the VPLs of one batch whose maps it has to be drawn to.
struct VplSet {
  uint triangle SHARED_ZERO;  // batch of the round << kTriangleBits | triangle
  uint vpls SHARED_ZERO;      // a bit for each VPL of the batch
};
SHARED_SIZE(VplSet, 8)

SHARED_END
