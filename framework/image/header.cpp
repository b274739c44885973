#include "framework/image/header.h"

#include <algorithm>
#include <array>

#include "framework/image/codec.h"

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

uint32_t littleEndian(std::istream& in) {
  std::array<char, 4> bytes{};
  in.read(bytes.data(), bytes.size());
  uint32_t value = 0;
  for (size_t i = bytes.size(); i-- > 0;) value = value << 8 | uint8_t(bytes[i]);
  return value;
}

// Whether what lies in an attribute of this type and size, of which the stream is at the beginning, claims more.
bool claimsMore(std::istream& in, const std::string& type, uint64_t size) {
  if (type == "preview") {  // width, height, and four bytes a pixel
    const uint64_t width = littleEndian(in), height = littleEndian(in);
    return size < 8 || (height > 0 && width > (size - 8) / 4 / height);
  }
  if (type == "stringvector")  // each with its length before it
    for (uint64_t left = size; in && left > 0;) {
      const uint64_t length = left >= 4 ? littleEndian(in) : left;
      if (length + 4 > left) return true;
      in.seekg(std::streamoff(length), std::ios::cur);
      left -= length + 4;
    }
  return false;
}

// Whether a side of the rectangle at which the stream is, the corners of its first and last pixels, is too long.
bool claimsTooLong(std::istream& in) {
  int64_t corners[4] = {};
  for (int64_t& corner : corners) corner = int32_t(littleEndian(in));
  return std::max(corners[2] - corners[0], corners[3] - corners[1]) >= int64_t{codec::kMaxSide};
}

}  // namespace

std::optional<HeaderSize> headerSize(std::span<const uint8_t> bytes) {
  static constexpr std::array<uint8_t, 4> kPng = {0x89, 'P', 'N', 'G'};
  if (bytes.size() >= 4 && std::equal(kPng.begin(), kPng.end(), bytes.begin())) return ofPng(bytes);
  if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return ofJpeg(bytes);
  return {};
}

// A header is a list of attributes, each with its name, type and size, and ends with an empty name. With several parts
// there is a list of headers, which ends with an empty one ("OpenEXR File Layout").
std::string whyForged(std::istream& exr) {
  exr.seekg(0, std::ios::end);
  const auto total = uint64_t(exr.tellg());
  exr.seekg(4);
  const bool severalParts = (littleEndian(exr) & 0x1000u) != 0;
  do {
    for (std::string name, type; std::getline(exr, name, '\0') && !name.empty();) {
      std::getline(exr, type, '\0');
      const uint64_t size = littleEndian(exr);
      if (!exr) return {};  // it ends here
      const auto begin = uint64_t(exr.tellg());
      if (size > total - begin || claimsMore(exr, type, size))
        return "its attribute `" + name + "` claims more bytes than there are";
      if (name == "dataWindow" && claimsTooLong(exr)) return "its `dataWindow` is longer than any picture";
      exr.seekg(std::streamoff(begin + size));
    }
  } while (severalParts && exr.peek() > 0);
  return {};
}

std::string whyTooPlain(uint64_t pixels, uint64_t bytes) {
  constexpr uint64_t kPlainPixels = uint64_t(1) << 26, kPixelsOfByte = 64;
  if (pixels <= kPlainPixels || (pixels - kPlainPixels) / kPixelsOfByte <= bytes) return {};
  return std::to_string(bytes) + " bytes claim " + std::to_string(pixels / 1'000'000) +
         " million pixels, which can show little more than plain colours";
}

}  // namespace fovea::image
