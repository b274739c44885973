// Images in memory and in files. OpenImageIO, where it is built in, stays behind this interface.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fovea::image {

// Float channels, interleaved, rows from the top.
struct Image {
  uint32_t width = 0, height = 0, channels = 0;
  std::vector<float> data;  // width * height * channels
  float& at(uint32_t x, uint32_t y, uint32_t c) { return data[(size_t(y) * width + x) * channels + c]; }
  float at(uint32_t x, uint32_t y, uint32_t c) const { return data[(size_t(y) * width + x) * channels + c]; }
};

struct Layer {
  std::string name;  // "radiance", "indirect", ...; "" for the only layer of a plain file
  Image image;
};

using Metadata = std::map<std::string, std::string>;

struct File {
  std::vector<Layer> layers;
  Metadata metadata;
  const Image* find(std::string_view layer) const;
};

// 8-bit RGBA, rows from the top; for glTF textures.
struct Image8 {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

// Which extensions can be written / read in this build ("exr", "png", ...).
std::vector<std::string> writableExtensions();

// By extension. EXR: all layers, 32-bit float, channel names "layer.R"; PFM: one 1- or 3-channel layer.
// PNG: one layer that is display-referred already (values 0..1 become 8 bits, rounded, no transfer curve applied); a
// pixel with a NaN becomes magenta. EXR and PFM keep NaN and infinity. Layers of one file have one size.
// EXR and PNG hold the metadata under "fovea.<key>" (UTF-8); entries with an empty value are left out.
// Written under a temporary name, read back, compared, renamed: an existing file survives every failure.
// Throws Error(CannotWrite) naming file and reason, Error(BadInput) for an unknown extension.
void write(const std::filesystem::path& file, const std::vector<Layer>& layers,
           const Metadata& metadata = {});
// Checks early that a file could be written there: extension known, folder exists and is writable.
void checkWritable(const std::filesystem::path& file);

// Throws Error(BadInput) naming file and reason. PNG and JPEG come back as stored (no transfer curve removed).
File read(const std::filesystem::path& file);
Image8 read8(const std::filesystem::path& file);
Image8 decode8(const uint8_t* bytes, size_t size, const std::string& name);  // a PNG or JPEG in memory

// sRGB transfer function (IEC 61966-2-1), scalar, input clamped to [0, 1].
float srgbEncode(float linear);
float srgbDecode(float encoded);

}  // namespace fovea::image
