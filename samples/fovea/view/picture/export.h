// Pictures to keep, as files in memory.
#pragma once

#include <string>

#include "fovea/image.h"
#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/picture/display.h"

namespace fovea::view {

// An EXR file with the floats of the shot as one layer, as `fovea render` writes it. Throws Error(BadInput) for a buffer.
std::string exrFile(const Shot& shot, const std::string& layer);
// A PNG file of the shot as it is shown. Throws Error(BadInput) for a buffer.
std::string pngFile(const Shot& shot, const Display& display);

}  // namespace fovea::view
