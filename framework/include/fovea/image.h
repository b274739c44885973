// Images in memory and in files. The interface does not depend on the image library that fovea was built with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fovea::image {

// Interleaved float channels; rows run from top to bottom.
struct Image {
  uint32_t width = 0, height = 0, channels = 0;
  std::vector<float> data;  // width * height * channels
  float& at(uint32_t x, uint32_t y, uint32_t c) { return data[(size_t(y) * width + x) * channels + c]; }
  float at(uint32_t x, uint32_t y, uint32_t c) const { return data[(size_t(y) * width + x) * channels + c]; }
};

struct Window {
  int32_t x = 0, y = 0;  // of the first pixel
  uint32_t width = 0, height = 0;
  bool operator==(const Window&) const = default;
};

struct Layer {
  std::string name;  // "radiance", "indirect", ...; "" for the only layer of a plain file
  Image image;
  std::vector<std::string> channels = {};  // their names ("R", "Z"); empty: Y or RGBA, by their number
  // The picture that the layer belongs to, and the pixels of it that `image` holds: in EXR files the display and the
  // data window. A width of 0 stands for all of the image.
  Window display = {}, data = {};
};

using Metadata = std::map<std::string, std::string>;

// A layer of a file, or a channel outside all layers, that is left out.
struct Unread {
  std::string name, reason;
};

struct File {
  std::vector<Layer> layers;
  Metadata metadata;
  std::vector<Unread> unread = {};
  bool radiance = false;  // of an EXR, PFM or HDR file; others hold display values
  const Image* find(std::string_view layer) const;
  const Layer* findLayer(std::string_view layer) const;
};

// 8-bit RGBA for glTF textures; rows run from top to bottom.
struct Image8 {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

// File extensions that this build can read and write ("exr", "png", ...).
std::vector<std::string> writableExtensions();

// Writes an image in the format that its extension names. All layers of a file have the same size.
// - EXR holds any number of layers as 32-bit floats, in channels named "layer.R".
// - PFM holds one layer of 1 or 3 channels.
// - PNG holds one layer that is already display-referred: values from 0 to 1 are rounded to 8 bits without a transfer
//   curve, and a pixel that contains NaN becomes magenta.
// EXR and PFM preserve NaN and infinity. EXR and PNG store metadata under "fovea.<key>" (UTF-8) and omit entries
// with an empty value. The file is written under a temporary name, read back, compared and renamed, so that an
// existing file survives every failure. Throws Error(CannotWrite) naming the file and the reason, and
// Error(BadInput) for an unknown extension.
void write(const std::filesystem::path& file, const std::vector<Layer>& layers,
           const Metadata& metadata = {});
// Checks in advance that a file can be written: the extension is known, and the folder exists and is writable.
void checkWritable(const std::filesystem::path& file);

// These throw Error(BadInput) naming the file and the reason. PNG and JPEG values are returned as stored, without
// removing a transfer curve. Of an EXR with several parts, all are read: the layers of a part are named after it
// ("albedo"), and after it and their own names ("left.albedo") where these differ. Of mip maps, the finest level is
// read. Deep parts, parts with a sample for several pixels (luminance and chroma), and channels of integers are left
// out and listed in `unread`; a file of nothing else is refused.
File read(const std::filesystem::path& file);
Image8 read8(const std::filesystem::path& file);
Image8 decode8(const uint8_t* bytes, size_t size, const std::string& name);  // a PNG or JPEG in memory

// The sRGB transfer function (IEC 61966-2-1) of a single value. The input is clamped to [0, 1].
float srgbEncode(float linear);
float srgbDecode(float encoded);

}  // namespace fovea::image
