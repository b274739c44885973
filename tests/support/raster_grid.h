// How finely the device's rasteriser places corners of triangles.
#pragma once

#include <cmath>

#include "framework/gpu/device.h"
#include "framework/session/test_device.h"

namespace fovea::test {

// Distance in pixels of the points on which corners are placed: 1/256 on most devices, 1/16 on SwiftShader, which is
// all that Vulkan asks for.
inline float rasterGrid() { return std::ldexp(1.0f, -int(testDevice().limits().subPixelPrecisionBits)); }

}  // namespace fovea::test
