// Visualises where an image differs from its reference.
#pragma once

#include "framework/image/color.h"
#include "framework/image/metrics.h"

namespace fovea::image {

// Maps a value from 0 (black) through violet, red and orange to 1 (light yellow); values outside are clamped. The
// lightness L* grows evenly, so that the order of values is kept for every eye and in print. Returns encoded sRGB.
Color mapColor(double value);

// The error of each pixel: the root of the mean over RGB of (T(a) - T(g))^2.
std::vector<float> pixelErrors(const Picture& picture, const Picture& reference);

// Draws `values` (from 0 to `greatest`, one per pixel, in rows of `width`) in the colours of mapColor, with the
// foveal circle and, if there is room, a scale below with the numbers 0, greatest / 2 and greatest. Throws
// Error(BadInput) if `greatest` is not positive. Returns display-referred RGB.
Image errorPicture(const std::vector<float>& values, uint32_t width, double greatest,
                   const Disc* fovea = nullptr);

}  // namespace fovea::image
