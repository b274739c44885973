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
  float unused SHARED_ZERO;
};
SHARED_SIZE(Reservoir, 48)
SHARED_OFFSET(Reservoir, normal, 32)

SHARED_END
