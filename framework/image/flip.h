// LDR-FLIP: how different two images look when they are shown one after the other in the same place.
//
// After Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. Sections are cited as "FLIP 4.1".
#pragma once

#include <vector>

#include "fovea/image.h"

namespace fovea::image {

// Pixels per degree of visual angle under the paper's viewing conditions: a screen 3840 pixels and 0.7 m wide, viewed
// from 0.7 m. The authors' tools use it as well.
inline constexpr double kDefaultPixelsPerDegree = 67.0;

// One value per pixel, from 0 (no visible difference) to 1 (the greatest possible one); rows run from top to bottom.
// Both images are given as displayed, in sRGB from 0 to 1 (clamped). The result is symmetric in the images. Throws
// Error(BadInput) if the sizes differ, if an image does not have three channels or contains NaN or infinity, or if
// the pixels per degree are not in [1, 1000].
std::vector<float> flip(const Image& reference, const Image& test,
                        double pixelsPerDegree = kDefaultPixelsPerDegree);

}  // namespace fovea::image
