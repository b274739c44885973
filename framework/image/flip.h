// LDR-FLIP: how different two pictures look when one is shown after the other in the same place.
//
// After Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator
// for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020; sections are quoted as
// "FLIP 4.1".
#pragma once

#include <vector>

#include "fovea/image.h"

namespace fovea::image {

// Pixels per degree of visual angle of the paper's viewing conditions: a screen 3840 pixels and 0.7 m wide,
// seen from 0.7 m. The authors' tools use it as well.
inline constexpr double kDefaultPixelsPerDegree = 67.0;

// A value per pixel, 0 (no visible difference) to 1 (the greatest there is), rows from the top. Both pictures
// as the screen shows them: RGB in sRGB, 0..1 (clamped). Symmetric. Throws Error(BadInput) on different
// sizes, other than three channels, NaN or infinity, or pixels per degree that are not in [1, 1000].
std::vector<float> flip(const Image& reference, const Image& test,
                        double pixelsPerDegree = kDefaultPixelsPerDegree);

}  // namespace fovea::image
