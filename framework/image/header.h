// The sizes that the header of a picture claims, read without decoding it.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/image.h"

namespace fovea::image {

struct HeaderSize {
  uint32_t width = 0, height = 0;
  uint64_t pixels() const { return uint64_t(width) * height; }
};
// Of a PNG or JPEG in memory; nothing if it is neither or has no such header.
std::optional<HeaderSize> headerSize(std::span<const uint8_t> bytes);

// Why files of so many bytes are not decoded though they claim so many pixels, or "". Plain colours compress a
// thousandfold, so that a small file can claim gigabytes; pictures with content have a byte for each 64 pixels, and up
// to 2^26 pixels may be plain.
std::string whyTooPlain(uint64_t pixels, uint64_t bytes);

// Why an EXR file is not read: an attribute of its header claims another size than it has, or the header claims a side
// of more than codec::kMaxSide pixels, blocks of more than 32 MiB or channels of an unknown type; else "". OpenEXR
// reserves and clears what a header claims, up to several GiB, before it notices, and OpenImageIO aborts at types that
// it does not know. What else is wrong with the file is left to them.
std::string whyForged(std::istream& exr);

// What the header of an EXR file says about one of its parts. Only headers to which whyForged() has no objection may be
// read.
struct ExrPart {
  struct Channel {
    std::string name;
    bool integers = false;
    int32_t xSampling = 1, ySampling = 1;  // pixels for each sample
  };
  std::string name;  // "" if the only part has none
  Window display, data;
  std::vector<Channel> channels;
  bool deep = false;
};
std::vector<ExrPart> exrParts(std::istream& exr);

}  // namespace fovea::image
