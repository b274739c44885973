#include "framework/image/header.h"

#include <algorithm>
#include <array>

namespace fovea::image {
namespace {

uint32_t bigEndian(std::span<const uint8_t> bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

// The first chunk of a PNG, IHDR, begins with width and height.
std::optional<HeaderSize> ofPng(std::span<const uint8_t> bytes) {
  if (bytes.size() < 24) return {};
  return HeaderSize{bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4)};
}

// A JPEG is a list of segments: 0xff, a marker, and a length that counts itself. A frame header (ITU-T T.81, B.2.2) has
// one of the markers 0xc0 to 0xcf but for three others, then the precision, the height and the width.
std::optional<HeaderSize> ofJpeg(std::span<const uint8_t> bytes) {
  for (size_t at = 2; at + 9 <= bytes.size();) {
    if (bytes[at] != 0xff) return {};
    const uint8_t marker = bytes[at + 1];
    if (marker == 0xff) {  // padding
      ++at;
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return HeaderSize{bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2)};
    at += 2 + std::max<uint32_t>(bigEndian(bytes, at + 2, 2), 2);
  }
  return {};
}

}  // namespace

std::optional<HeaderSize> headerSize(std::span<const uint8_t> bytes) {
  static constexpr std::array<uint8_t, 4> kPng = {0x89, 'P', 'N', 'G'};
  if (bytes.size() >= 4 && std::equal(kPng.begin(), kPng.end(), bytes.begin())) return ofPng(bytes);
  if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return ofJpeg(bytes);
  return {};
}

std::string whyTooPlain(uint64_t pixels, uint64_t bytes) {
  constexpr uint64_t kPlainPixels = uint64_t(1) << 26, kPixelsOfByte = 64;
  if (pixels <= kPlainPixels || (pixels - kPlainPixels) / kPixelsOfByte <= bytes) return {};
  return std::to_string(bytes) + " bytes claim " + std::to_string(pixels / 1'000'000) +
         " million pixels, which can show little more than plain colours";
}

}  // namespace fovea::image
