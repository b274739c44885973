// What one image library has to offer; image.cpp builds files, layers and safety on it. One implementation is linked:
// codec_oiio.cpp (OpenImageIO) or codec_small.cpp (tinyexr, libpng, stb: small enough for a portable bundle).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/image.h"

namespace fovea::image::codec {

// Named channels, interleaved, rows from the top.
struct Pixels {
  uint32_t width = 0, height = 0;
  std::vector<std::string> channels;  // "R", "indirect.G", ...
  std::vector<float> data;
  Metadata metadata;  // keys as in the file: "fovea.graph"
};

// Extensions both read and written, without the dot. PFM is not among them: image.cpp does it itself.
std::vector<std::string> extensions();

// All three throw std::runtime_error with the library's reason. The format follows the (lower-case) extension.
// EXR: 32-bit float; PNG: 8 bits a channel, values 0..1, alpha not premultiplied.
void write(const std::filesystem::path& file, const Pixels& pixels);
Pixels read(const std::filesystem::path& file);
Image8 decode8(const uint8_t* bytes, size_t size);

inline constexpr uint32_t kMaxSide = 32768;  // pixels; larger headers are taken for broken files

}  // namespace fovea::image::codec
