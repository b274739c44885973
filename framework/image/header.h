// The size of a picture, read from the first bytes of a file without decoding it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace fovea::image {

struct HeaderSize {
  uint32_t width = 0, height = 0;
  uint64_t pixels() const { return uint64_t(width) * height; }
};
// Of a PNG or JPEG in memory; nothing if it is neither or has no such header.
std::optional<HeaderSize> headerSize(std::span<const uint8_t> bytes);

// Why files of so many bytes are not decoded though they claim so many pixels, or "". Plain colours compress a
// thousandfold, so that a small file can ask for gigabytes; whatever shows something has a byte for each 64 pixels, and
// up to 2^26 pixels may be plain.
std::string whyTooPlain(uint64_t pixels, uint64_t bytes);

}  // namespace fovea::image
