// PFM, the simplest float format: a text header and raw 32-bit floats; rows run from bottom to top.
#pragma once

#include "framework/image/codec.h"

namespace fovea::image {

// Images have 1 or 3 channels; metadata is dropped. Both functions throw std::runtime_error with the reason.
void writePfm(const std::filesystem::path& file, const codec::Pixels& pixels);
codec::Pixels readPfm(const std::filesystem::path& file);

}  // namespace fovea::image
