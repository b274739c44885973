// Constants of pass contact-rays, and when two points count as lying on one plane.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// Keeps the random numbers of the rays apart from others.
SHARED_CONSTANT uint kContactStream = 0x636f6e74u;
SHARED_CONSTANT uint kContactSubsets = 4u;  // a pixel looks at one of so many subsets of the VPLs in a frame
SHARED_CONSTANT float kContactRayEnd = 0.999f;  // rays end just before the VPL's surface
SHARED_CONSTANT float kLeastChance =
    0.1f;  // of a VPL that no ray has reached, relative to one that all reach
SHARED_CONSTANT uint kTallySums =
    16u;  // partial sums of the counts of rays, so that fewer threads add to the same one
SHARED_CONSTANT float kTallyKept = 0.75f;  // share of the tallies that is kept from frame to frame
SHARED_CONSTANT float kMiddleWeight =
    2.0f;  // of the pixel in the middle of a row of three; the others have 1

// Samples may share their light if the cosine between their normals exceeds the first, and if one is off the other's
// tangent plane by at most the second times their distance (onSamePlane() in screen/same_surface.glsl).
SHARED_CONSTANT float kSamePlaneCos = 0.9f;
SHARED_CONSTANT float kSamePlaneSlope = 0.1f;

SHARED_END
