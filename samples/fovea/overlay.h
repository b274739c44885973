// What the eye of a frame looks at, drawn onto a picture.
#pragma once

#include <glm/glm.hpp>

#include "framework/image/image.h"

namespace fovea::cli {

// The foveal circle and a cross where the eye looks. gaze: normalised, origin top-left, may lie outside the
// picture; radius: image widths.
void drawFovea(image::Image& picture, glm::vec2 gaze, float radius);

}  // namespace fovea::cli
