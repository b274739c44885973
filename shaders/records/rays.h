// The bounding volume hierarchies of a scene, and constants of rays (shaders/rays).
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// A node of a binary tree. Two texels of `rayNodes`.
struct BvhNode {
  vec3 low SHARED_ZERO;  // corners of its box, world space, m
  // Of a leaf its first entry in the order of triangles, of an inner node the first of its two children.
  uint first SHARED_ZERO;
  vec3 high SHARED_ZERO;
  uint count SHARED_ZERO;  // number of triangles of a leaf; 0 for an inner node
};
SHARED_SIZE(BvhNode, 32)
SHARED_OFFSET(BvhNode, high, 16)

SHARED_CONSTANT uint kBvhLeaf = 4u;    // most triangles of a leaf
SHARED_CONSTANT uint kBvhDepth = 72u;  // more levels than any tree has

// Where the roots of the two trees are in `rayNodes`: that of the triangles that never move, and that of all others.
// Place 0 is empty, so that 0 can stand for no children.
SHARED_CONSTANT uint kBvhStill = 1u, kBvhMoving = 2u, kBvhTops = 3u;

// In the last component of an entry of `rayTriangles`, beside the triangle: it may have holes.
SHARED_CONSTANT uint kRayHoles = 0x80000000u;

SHARED_CONSTANT float kRayEpsilon =
    1e-5f;  // of the scene's diagonal: keeps rays off the surface that they leave
SHARED_CONSTANT float kLeastDiagonal = 1e-3f;    // m
SHARED_CONSTANT float kLeastDirection = 1e-30f;  // of a component of a direction, for boxes
SHARED_CONSTANT float kShadowEnd = 0.9999f;      // rays towards lights end just before them
SHARED_CONSTANT uint kMaxPanes = 64u;            // surfaces that light passes on its way

SHARED_CONSTANT uint kGoldenRatio = 2654435769u, kSilverRatio = 1779033704u;  // steps of sequences, in 2^-32

// Keep the random numbers of rays that are aimed at emitters and of those that pass surfaces apart from others.
SHARED_CONSTANT uint kAimedRayStream = 0x656d6974u, kPassedRayStream = 0x72617973u;
// And those that choose one of the ways in which a surface reflects light.
SHARED_CONSTANT uint kLobeStream = 0x6c6f6265u;

// The least roughness with which surfaces reflect light towards those that the eye sees, and towards others. With less,
// single paths show as bright spots.
SHARED_CONSTANT float kBounceRoughness = 0.3f, kGatheredRoughness = 0.5f;

SHARED_END
