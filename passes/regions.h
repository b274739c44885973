// Parameters of passes that take points in a region of the picture (shaders/sampling/fovea.glsl).
#pragma once

#include <cmath>
#include <cstdint>

namespace fovea::passes {

// The parameter `image_share` in 64ths, as the shaders take it.
inline uint32_t imageShare64ths(double share) { return uint32_t(std::lround(64 * share)); }

}  // namespace fovea::passes
