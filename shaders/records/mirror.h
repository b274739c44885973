// Constants of pass reflections, and which lobes it traces.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// Keep the random numbers of rays from mirrors, and of what they gather, apart from others.
SHARED_CONSTANT uint kMirrorStream = 0x6d697272u, kMirrorLightStream = 0x6d696c69u;

// The code of a sample where nothing reflects. Its bit 10 says so.
SHARED_CONSTANT float kNoMirror = -1024.0f;

// The share of the light under a lobe that rays find, and not VPLs, falls to 0 from these roughnesses on, over
// kTracedFade. It is larger for metals, as their lobe shows more; these have a channel of F0 above kMetallicF0.
SHARED_CONSTANT float kTracedDielectric = 0.3f, kTracedMetal = 0.7f, kTracedFade = 0.15f, kMetallicF0 = 0.15f;

SHARED_CONSTANT float kMirrorCellWidth =
    0.02f;                                  // of the cache's cells, in distances of the mirror from the eye
SHARED_CONSTANT float kSharp = 0.04f;       // GGX's alpha from which neighbours share all of their light
SHARED_CONSTANT int kSharing = 2;           // texels as far as this from each other share their light
SHARED_CONSTANT float kLeastReach = 1e-6f;  // m: least distance of what a ray met that counts
// A ray into the surface is shared as if it had met something at this distance, which is multiplied by the mirror's
// distance from the eye and divided by GGX's alpha. The lobes of mirrors four pixels apart hardly part there.
SHARED_CONSTANT float kHardlyApart = 0.02f;
SHARED_CONSTANT float kOutside = 1e5f;  // m: stands for the distance of the environment
SHARED_CONSTANT float kSameSlope =
    0.1f;  // most of a line between two points of one surface, against its plane
SHARED_CONSTANT float kLeastLobe = 1e-3f;  // of a cosine to the eye and of an albedo

SHARED_END
