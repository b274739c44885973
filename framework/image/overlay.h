// Draws the gaze onto an image.
#pragma once

#include "framework/image/metrics.h"

namespace fovea::image {

// Draws the foveal circle and a cross at the gaze, white on black, into the first three channels of
// a display-referred image.
void drawFovea(Image& picture, const Disc& fovea);

}  // namespace fovea::image
