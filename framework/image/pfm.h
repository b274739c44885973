// PFM, the simplest float format: a text header and raw 32-bit floats, rows from the bottom.
#pragma once

#include "framework/image/codec.h"

namespace fovea::image {

// 1 or 3 channels; metadata is dropped. Both throw std::runtime_error with the reason.
void writePfm(const std::filesystem::path& file, const codec::Pixels& pixels);
codec::Pixels readPfm(const std::filesystem::path& file);

}  // namespace fovea::image
