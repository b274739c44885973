#include "framework/image/header.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>

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
// one of the markers 0xc0 to 0xcf but for three others, then the precision, the height and the width. Decoders skip what
// is between the segments.
std::optional<HeaderSize> ofJpeg(std::span<const uint8_t> bytes) {
  for (size_t at = 2; at + 9 <= bytes.size();) {
    const uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == 0x00 || marker == 0xff) {
      ++at;
      continue;
    }
    const bool alone = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7);  // without a length
    if (alone) {
      at += 2;
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

// How many bytes OpenEXR reads of an attribute of this type and size, at whose content the stream is. It reads many types
// by their content and does not look at the size.
uint64_t bytesRead(std::istream& in, const std::string& type, uint64_t size) {
  static const std::map<std::string, uint64_t, std::less<>> kSizes = {{"box2i", 16},
                                                                      {"box2f", 16},
                                                                      {"chromaticities", 32},
                                                                      {"compression", 1},
                                                                      {"deepImageState", 1},
                                                                      {"double", 8},
                                                                      {"envmap", 1},
                                                                      {"float", 4},
                                                                      {"int", 4},
                                                                      {"keycode", 28},
                                                                      {"lineOrder", 1},
                                                                      {"m33f", 36},
                                                                      {"m33d", 72},
                                                                      {"m44f", 64},
                                                                      {"m44d", 128},
                                                                      {"rational", 8},
                                                                      {"tiledesc", 9},
                                                                      {"timecode", 8},
                                                                      {"v2i", 8},
                                                                      {"v2f", 8},
                                                                      {"v2d", 16},
                                                                      {"v3i", 12},
                                                                      {"v3f", 12},
                                                                      {"v3d", 24}};
  if (const auto known = kSizes.find(type); known != kSizes.end()) return known->second;
  if (type == "preview") {  // width, height, and four bytes a pixel
    const uint64_t width = littleEndian(in), height = littleEndian(in);
    return 8 + (width > 0 && height > size / width ? size : 4 * width * height);
  }
  uint64_t bytes = 0;
  if (type == "chlist") {  // names, and 16 bytes each, up to an empty name
    for (std::string name; std::getline(in, name, '\0') && !name.empty(); in.ignore(16))
      bytes += name.size() + 1 + 16;
    return bytes + 1;
  }
  if (type == "stringvector") {  // each with its length before it
    while (in && bytes < size) {
      const uint64_t length = littleEndian(in);
      bytes += 4 + length;
      in.seekg(std::streamoff(length), std::ios::cur);
    }
    return bytes;
  }
  return size;
}

// What decides how much memory OpenEXR reserves for one block of a part's pixels as it opens the file, and whether
// OpenImageIO knows its values.
struct Block {
  uint64_t columns = 0, rows = 0, bytesPerPixel = 0;
  bool tiled = false;
  uint64_t tileColumns = 0, tileRows = 0;
  uint64_t lines = 1;   // of a compressed block without tiles
  std::string unknown;  // the name of a channel with values of an unknown type
  uint64_t bytes() const { return (tiled ? tileColumns * tileRows : columns * lines) * bytesPerPixel; }
};

constexpr uint64_t kMostOfBlock = uint64_t(1) << 25;  // bytes; OpenEXR has two blocks for each thread

void addChannels(Block& block, std::istream& channels) {
  for (std::string name; std::getline(channels, name, '\0') && !name.empty();) {
    constexpr uint32_t kHalf = 1, kTypes = 3;  // unsigned integers, halves and floats
    const uint32_t type = littleEndian(channels);
    block.bytesPerPixel += type == kHalf ? 2 : 4;
    if (type >= kTypes) block.unknown = name;
    channels.ignore(12);  // flags, and how sparse its samples are
  }
}

// By the number that a header gives to a compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
uint64_t linesOfBlock(int compression) {
  static constexpr std::array<uint64_t, 10> kLines = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return kLines[size_t(std::clamp(compression, 0, int(kLines.size()) - 1))];
}

// Reads the properties of the blocks from an attribute at whose content the stream is.
void addTo(Block& block, const std::string& name, std::istream& in) {
  if (name == "dataWindow") {  // the corners of its first and last pixels
    int64_t corners[4] = {};
    for (int64_t& corner : corners) corner = int32_t(littleEndian(in));
    block.columns = uint64_t(std::max<int64_t>(corners[2] - corners[0] + 1, 0));
    block.rows = uint64_t(std::max<int64_t>(corners[3] - corners[1] + 1, 0));
  } else if (name == "channels") {
    addChannels(block, in);
  } else if (name == "compression") {
    block.lines = linesOfBlock(in.get());
  } else if (name == "type") {  // of one of several parts; a single part has a flag instead
    std::string type(5, ' ');
    in.read(type.data(), std::streamsize(type.size()));
    block.tiled = type == "tiled" || type == "deept";
  } else if (name == "tiles") {
    block.tileColumns = littleEndian(in);
    block.tileRows = littleEndian(in);
  }
}

std::string whyForged(const Block& block) {
  if (!block.unknown.empty()) return "its channel `" + block.unknown + "` has values of an unknown type";
  if (std::max(block.columns, block.rows) > codec::kMaxSide)
    return "its `dataWindow` is longer than any picture";
  if (std::max(block.tileColumns, block.tileRows) > codec::kMaxSide)
    return "its tiles are longer than any picture";
  if (block.bytes() > kMostOfBlock)
    return "one block of its pixels claims " + std::to_string(block.bytes() >> 20) + " MiB of at most " +
           std::to_string(kMostOfBlock >> 20);
  return {};
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
  const uint32_t flags = littleEndian(exr);
  const bool severalParts = (flags & 0x1000u) != 0, tiled = (flags & 0x200u) != 0;
  do {
    Block block;
    for (std::string name, type; std::getline(exr, name, '\0') && !name.empty();) {
      std::getline(exr, type, '\0');
      const uint64_t size = littleEndian(exr);
      if (!exr) return {};  // it ends here
      const auto begin = uint64_t(exr.tellg());
      if (size > total - begin || bytesRead(exr, type, size) != size)
        return "its attribute `" + name + "` has another size than it claims";
      exr.seekg(std::streamoff(begin));
      addTo(block, name, exr);
      exr.seekg(std::streamoff(begin + size));
    }
    if (!severalParts) block.tiled = tiled;
    if (const std::string reason = whyForged(block); !reason.empty()) return reason;
  } while (severalParts && exr.peek() > 0);
  return {};
}

namespace {

Window windowOf(std::istream& in) {
  int64_t corners[4] = {};
  for (int64_t& corner : corners) corner = int32_t(littleEndian(in));
  return {int32_t(corners[0]), int32_t(corners[1]),
          uint32_t(std::max<int64_t>(corners[2] - corners[0] + 1, 0)),
          uint32_t(std::max<int64_t>(corners[3] - corners[1] + 1, 0))};
}

void addTo(ExrPart& part, const std::string& name, uint64_t size, std::istream& in) {
  if (name == "displayWindow" || name == "dataWindow") {
    (name == "dataWindow" ? part.data : part.display) = windowOf(in);
  } else if (name == "name" || name == "type") {
    std::string text(size, ' ');
    in.read(text.data(), std::streamsize(size));
    if (name == "name")
      part.name = text;
    else
      part.deep |= text.starts_with("deep");
  } else if (name == "channels") {
    for (std::string channel; std::getline(in, channel, '\0') && !channel.empty();) {
      const bool integers = littleEndian(in) == 0;
      in.ignore(4);  // linearity, and three reserved bytes
      const auto x = int32_t(littleEndian(in)), y = int32_t(littleEndian(in));
      part.channels.push_back({channel, integers, x, y});
    }
  }
}

}  // namespace

std::vector<ExrPart> exrParts(std::istream& exr) {
  exr.clear();
  exr.seekg(0, std::ios::end);
  const auto total = uint64_t(exr.tellg());
  exr.seekg(4);
  const uint32_t flags = littleEndian(exr);
  const bool severalParts = (flags & 0x1000u) != 0, deep = (flags & 0x800u) != 0;
  std::vector<ExrPart> parts;
  do {
    ExrPart part;
    part.deep = deep && !severalParts;
    for (std::string name, type; std::getline(exr, name, '\0') && !name.empty();) {
      std::getline(exr, type, '\0');
      const uint64_t size = littleEndian(exr);
      if (!exr) return {};  // it ends here
      const std::streamoff begin = exr.tellg();
      if (size > total - uint64_t(begin)) return {};
      addTo(part, name, size, exr);
      exr.clear();
      exr.seekg(begin + std::streamoff(size));
    }
    parts.push_back(std::move(part));
  } while (severalParts && exr.peek() > 0);
  return parts;
}

std::string whyTooPlain(uint64_t pixels, uint64_t bytes) {
  constexpr uint64_t kPlainPixels = uint64_t(1) << 26, kPixelsOfByte = 64;
  if (pixels <= kPlainPixels || (pixels - kPlainPixels) / kPixelsOfByte <= bytes) return {};
  return std::to_string(bytes) + " bytes claim " + std::to_string(pixels / 1'000'000) +
         " million pixels, which can show little more than plain colours";
}

}  // namespace fovea::image
