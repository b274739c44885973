// What the eye looks at, drawn onto a picture.
#pragma once

#include "framework/image/metrics.h"

namespace fovea::image {

// The foveal circle and a cross where the eye looks, white on black, in the first three channels of a
// display-referred picture.
void drawFovea(Image& picture, const Disc& fovea);

}  // namespace fovea::image
