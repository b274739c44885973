// Reservoirs of indirect light, one for each pixel, as the passes of ReSTIR GI exchange them.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::passes)

// A sample is chosen in proportion to the luminance of its light, dot(radiance, kLuminance), times the cosine at the
// pixel's surface.
SHARED_CONSTANT vec3 kLuminance = {0.2126f, 0.7152f, 0.0722f};

// One sample of the light that reaches what a pixel shows: a point that sends light there. Where the light comes from
// the environment, it is a very distant point. All zeros mean that nothing was sampled.
struct Reservoir {
  vec3 position SHARED_ZERO;  // of the point, world space, m
  float count SHARED_ZERO;    // M: number of samples among which this one was chosen
  vec3 radiance SHARED_ZERO;  // leaves the point towards the pixel's surface, W/(sr m^2)
  // W: estimate of 1 / density with which the pixel gets this sample, sr; 0 if no light was found.
  float weight SHARED_ZERO;
  vec3 normal SHARED_ZERO;  // geometric one of the point, unit, on the side of the light
  // 1 + number of its triangle past FrameBlock::firstMovingTriangle (exact below 2^24); 0 for what cannot move.
  float mover SHARED_ZERO;
};
SHARED_SIZE(Reservoir, 48)
SHARED_OFFSET(Reservoir, normal, 32)

// Keep the random numbers of rays, of the choice among them, of what they are aimed at and of what is gathered apart.
SHARED_CONSTANT uint kGiSampleStream = 0x67697361u, kGiChoiceStream = 0x67696368u, kGiAimStream = 0x67696169u,
                     kGiGatherStream = 0x67696774u;
SHARED_CONSTANT float kSky = 1e6f;                 // distance of the points that stand for the environment, m
SHARED_CONSTANT uint kMostSources = 16u;           // whose samples a pixel may share
SHARED_CONSTANT float kReservoirRayEnd = 0.9999f;  // rays end just before the sample

SHARED_END
