// What passes spend on a new fovea after the gaze has jumped.
#pragma once

#include <cmath>
#include <cstdint>

#include "framework/scene/frame.h"

namespace fovea::passes {

// Rays for each sample in the fovea: `most` when the gaze has just jumped, one when it rests (Frame::saccade).
inline uint32_t raysPerSample(const scene::Frame& frame, uint32_t most) {
  return 1 + uint32_t(std::lround(frame.saccade * float(most - 1)));
}

}  // namespace fovea::passes
