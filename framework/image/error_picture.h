// Where a picture differs from its reference, as a picture.
#pragma once

#include "framework/image/color.h"
#include "framework/image/metrics.h"

namespace fovea::image {

// Colour of a value from 0 (black) to 1 (light yellow), through violet, red and orange; beyond, the end's.
// Its lightness L* grows evenly, so that it keeps its order for every eye and in print. Encoded sRGB.
Color mapColor(double value);

// The errors of the pixels: root of the mean over RGB of (T(a) - T(g))^2.
std::vector<float> pixelErrors(const Picture& picture, const Picture& reference);

// `values` (0 to `greatest`, a pixel each, rows of `width`) in the colours of mapColor, the foveal circle,
// and below them, where there is room, a scale with the numbers 0, greatest / 2 and greatest. Throws
// Error(BadInput) for a greatest that is not positive. Display-referred RGB.
Image errorPicture(const std::vector<float>& values, uint32_t width, double greatest,
                   const Disc* fovea = nullptr);

}  // namespace fovea::image
