// The size of a picture, read from the first bytes of a file without decoding it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace fovea::image {

struct HeaderSize {
  uint32_t width = 0, height = 0;
  uint64_t pixels() const { return uint64_t(width) * height; }
};
// Of a PNG or JPEG in memory; nothing if it is neither or has no such header.
std::optional<HeaderSize> headerSize(std::span<const uint8_t> bytes);

}  // namespace fovea::image
