// The fovea on the image plane, and the regions of the image in which samples lie (sampling/fovea.glsl).
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// Image positions are in pixels from the top left corner; the centre of pixel (x, y) is at (x + 0.5, y + 0.5).
struct Fovea {
  vec2 centre SHARED_ZERO;   // may lie outside the image
  float radius SHARED_ZERO;  // r_f, pixels
};

// Values of the parameter `region`.
SHARED_CONSTANT uint kRegionFovea = 0u, kRegionImage = 1u;
SHARED_CONSTANT uint kRegionMixed = 2u;  // a share of the samples, evenly interspersed, from the whole image

// Numbers [0, kRegionDraws) of a random stream belong to regionSample(), at most two per try.
SHARED_CONSTANT uint kRegionTries = 32u;
SHARED_CONSTANT uint kRegionDraws = 2u * kRegionTries + 2u;

SHARED_END
