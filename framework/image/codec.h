// The interface of one image library; image.cpp adds files, layers and safety. There are two implementations:
// codec_oiio.cpp (OpenImageIO, in a library of its own that codec_load.cpp loads) and codec_small.cpp (tinyexr, libpng
// and stb; small enough for a portable bundle).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fovea/image.h"

namespace fovea::image::codec {

// Named, interleaved channels; rows run from top to bottom.
struct Pixels {
  uint32_t width = 0, height = 0;
  std::vector<std::string> channels;  // "R", "indirect.G", ...
  std::vector<float> data;
  Metadata metadata;  // keys as in the file: "fovea.graph"
};

// Extensions that are both read and written, without the dot. PFM is not among them; image.cpp handles it itself.
inline constexpr const char* kExtensions[] = {"exr", "png"};

// Hears of width, height and channels before anything is decoded, and may throw.
using Accept = std::function<void(uint32_t, uint32_t, size_t)>;

// All three throw std::runtime_error with the library's reason. The format follows from the (lower-case) extension.
// EXR holds 32-bit floats. PNG holds 8 bits per channel, values from 0 to 1 and alpha that is not premultiplied.
struct Library {
  void (*write)(const std::filesystem::path& file, const Pixels& pixels);
  // `part`: of an EXR file; 0 for any other.
  Pixels (*read)(const std::filesystem::path& file, uint32_t part, const Accept& accept);
  Image8 (*decode8)(const uint8_t* bytes, size_t size, const Accept& accept);
};

// The implementation there is. Throws Error(BadInput) if it cannot be loaded.
const Library& library();

inline constexpr uint32_t kMaxSide = 32768;  // pixels; larger sizes in a header indicate a broken file

}  // namespace fovea::image::codec
