// The bundle `eye-paths`: diffuse paths from fixed points of the screen, one bounce each.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// What a screen point shows. All zeros stand for the background.
struct EyePathStart {
  vec3 position SHARED_ZERO;  // world space, m
  float there SHARED_ZERO;    // 1 if there is a surface
  vec3 normal SHARED_ZERO;    // shading normal, unit, on the side of the eye
  float unused0 SHARED_ZERO;
  vec3 face SHARED_ZERO;  // normal of the triangle, unit
  float unused1 SHARED_ZERO;
};
SHARED_SIZE(EyePathStart, 48)
SHARED_OFFSET(EyePathStart, face, 32)

// All zeros mean that the path hits nothing.
struct EyePathEnd {
  vec3 position SHARED_ZERO;  // world space, m
  // 1 without direct light of lamps, 2 with it, 3 where the surface emits more than it reflects of that, 4 where the
  // scene has emissive surfaces and it reflects more of other light than of lamps.
  float kind SHARED_ZERO;
  vec3 normal SHARED_ZERO;  // unit, on the side from which the path came
  // Number of cosine-weighted paths that this one stands for; 1 unless some paths are aimed at emissive surfaces.
  float weight SHARED_ZERO;
  vec3 radiance SHARED_ZERO;  // leaves towards the start of the path, W/(sr m^2)
  float unit SHARED_ZERO;  // unit of sums as whole numbers, W/(sr m^2), the same for all ends; see sumUnit()
};
SHARED_SIZE(EyePathEnd, 48)
SHARED_OFFSET(EyePathEnd, radiance, 32)

// ---- Constants of pass eye-paths, and what it keeps ----

// Keep the random numbers of paths and of what their ends gather apart.
SHARED_CONSTANT uint kEyePathStream = 0x70617468u, kPathGatherStream = 0x67617468u;

SHARED_CONSTANT float kSamePlace = 1e-3f;  // relative to the distance from the eye
SHARED_CONSTANT float kSameFace = 0.9f;    // least cosine between the normals of one surface, a frame apart
SHARED_CONSTANT float kStill = 0.25f;      // of a ray's epsilon: how far rounding may move a surface
SHARED_CONSTANT uint kAimedShare = 4u;     // where surfaces emit, one of this many paths is aimed at them
// Share of points traced out of turn, in shares of light that has changed.
SHARED_CONSTANT float kOutOfTurn = 2.0f;
// How much more the square of an error that all pixels share weighs than that of noise: light that should be gone is
// noticed more.
SHARED_CONSTANT float kBiasWeight = 16.0f;
SHARED_CONSTANT float kRegained = 0.25f;   // share of what was lost that is regained in each frame
SHARED_CONSTANT float kUsualKept = 0.75f;  // share of the usual change that is kept from frame to frame

SHARED_CONSTANT float kChannelSum =
    2147483648.0f;  // of the light of all ends in the brightest channel, in units

// What the paths of a point do in a frame.
SHARED_CONSTANT uint kPathsAnew = 1u;  // they have another start than before
SHARED_CONSTANT uint kPathsWait = 2u;  // it is not their turn

// By how much the light that a path finds now differs from what it found before.
struct EyePathDifference {
  float changed SHARED_ZERO;  // without its sign
  float gained SHARED_ZERO;
  float larger SHARED_ZERO;  // the larger of both
  float unused SHARED_ZERO;
};
SHARED_SIZE(EyePathDifference, 16)

// Kept from frame to frame.
struct EyePathMemory {
  float usualChange SHARED_ZERO;  // largest change of the frames so far, forgotten in a few of them
  float lost SHARED_ZERO;         // z of the output `change`
  float outOfTurn SHARED_ZERO;    // share of the waiting points whose paths are traced all the same
  float unused SHARED_ZERO;
};
SHARED_SIZE(EyePathMemory, 16)

SHARED_END
