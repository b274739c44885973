// The light sources that rays are aimed at (rays/emitters.glsl), in the texels of `rayEmitters`: an EmitterHeader, the
// EmitterRecords, the EmitterNodes, and the tables by which directions to the environment map are chosen.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

struct EmitterHeader {
  uint count SHARED_ZERO;      // emissive triangles
  uint firstNode SHARED_ZERO;  // texel of EmitterNode 0
  // Texel at which the map's cumulative light starts, four values in each: a row of values for each row of texels, then
  // one value for each row. 0 if there is no map.
  uint firstMap SHARED_ZERO;
  uint unused SHARED_ZERO;
};
SHARED_SIZE(EmitterHeader, 16)

SHARED_CONSTANT uint kEmitterBothSides = 0x80000000u;  // in EmitterRecord::triangle

// The triangles in the order of the tree's leaves, and beside that the way back: `sorted` grows from record to record.
struct EmitterRecord {
  uint triangle SHARED_ZERO;   // with kEmitterBothSides if its material is double-sided
  float radiance SHARED_ZERO;  // estimate of its mean, over the channels, W/(sr m^2)
  uint sorted SHARED_ZERO;     // a triangle,
  uint place SHARED_ZERO;      // and its place in the order of the leaves
};
SHARED_SIZE(EmitterRecord, 16)

// Node i of the tree has the children 2 i and 2 i + 1, each with half of its emitters; the root is node 1.
struct EmitterNode {
  vec3 centre SHARED_ZERO;          // of its box, world space, m
  float radius2 SHARED_ZERO;        // squared half diagonal of its box, m^2
  vec3 axis SHARED_ZERO;            // of the cone of its normals, unit
  float spread SHARED_DEFAULT(-1);  // cosine of half the cone's angle, -1 if it holds all directions
  float power SHARED_ZERO;          // mean of the channels, W / pi
  float unused0 SHARED_ZERO;
  float unused1 SHARED_ZERO;
  float unused2 SHARED_ZERO;
};
SHARED_SIZE(EmitterNode, 48)
SHARED_OFFSET(EmitterNode, axis, 16)

SHARED_CONSTANT uint kEmittersInLeaf = 4u;    // most emitters in a leaf
SHARED_CONSTANT float kConeRounding = 1e-5f;  // by which cones are wider than the normals in them
// A triangle that is closer than so many of its squared radii sends no more light for that. Within more of them it is
// quartered, and so are its pieces, up to so many times.
SHARED_CONSTANT float kNearPiece = 0.25f;
SHARED_CONSTANT float kFarPiece = 4.0f;
SHARED_CONSTANT uint kMostQuarterings = 8u;
SHARED_CONSTANT float kLeastEmitterCosine = 1e-3f;  // of a bound, so that rounding leaves nothing out

SHARED_END
