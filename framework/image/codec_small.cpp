#include <png.h>
#include <stb_image.h>
#include <tinyexr.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "framework/image/codec.h"

namespace fovea::image::codec {

namespace {

[[noreturn]] void fail(const std::string& reason) { throw std::runtime_error(reason); }

void checkSize(int64_t width, int64_t height) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    fail("its size " + std::to_string(width) + "x" + std::to_string(height) +
         " is not within 1x1 and 32768x32768");
}

std::vector<uint8_t> readBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// ---- EXR: one part, scan lines, 32-bit floats --------------------------------------------------------------------

struct Exr {
  EXRHeader header;
  EXRImage image;
  bool owned = false;  // owned by tinyexr, after loading
  Exr() { InitEXRHeader(&header), InitEXRImage(&image); }
  ~Exr() {
    if (owned) FreeEXRImage(&image), FreeEXRHeader(&header);
  }
};

std::string reasonOf(const char* message) {
  const std::string text = message ? message : "the image library gives no reason";
  FreeEXRErrorMessage(message);
  return text;
}

void copyName(char (&to)[256], const std::string& name) {
  if (name.size() > 255) fail("the name `" + name + "` has more than 255 characters");
  std::memcpy(to, name.c_str(), name.size() + 1);
}

void writeExr(const std::filesystem::path& file, const Pixels& pixels) {
  const size_t channels = pixels.channels.size(), count = size_t(pixels.width) * pixels.height;
  std::vector<size_t> order(channels);  // EXR requires channels sorted by name
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return pixels.channels[a] < pixels.channels[b]; });
  std::vector<std::vector<float>> planes(channels, std::vector<float>(count));
  std::vector<EXRChannelInfo> infos(channels);
  std::vector<unsigned char*> pointers(channels);
  std::vector<int> types(channels, TINYEXR_PIXELTYPE_FLOAT);
  for (size_t c = 0; c < channels; ++c) {
    copyName(infos[c].name, pixels.channels[order[c]]);
    for (size_t i = 0; i < count; ++i) planes[c][i] = pixels.data[i * channels + order[c]];
    pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
  }
  std::vector<EXRAttribute> attributes;
  for (const auto& [key, value] : pixels.metadata) {
    EXRAttribute& a = attributes.emplace_back();
    copyName(a.name, key);
    std::strcpy(a.type, "string");
    a.value = reinterpret_cast<unsigned char*>(const_cast<char*>(value.data()));
    a.size = int(value.size());
  }
  Exr exr;
  exr.header.num_channels = exr.image.num_channels = int(channels);
  exr.header.channels = infos.data();
  exr.header.pixel_types = exr.header.requested_pixel_types = types.data();
  exr.header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  exr.header.num_custom_attributes = int(attributes.size());
  exr.header.custom_attributes = attributes.data();
  exr.image.images = pointers.data();
  exr.image.width = int(pixels.width);
  exr.image.height = int(pixels.height);
  const char* message = nullptr;
  unsigned char* memory = nullptr;
  const size_t bytes = SaveEXRImageToMemory(&exr.image, &exr.header, &memory, &message);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(memory, std::free);
  if (bytes == 0) fail(reasonOf(message));
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(memory), std::streamsize(bytes));
  stream.close();
  if (!stream) fail(errno ? std::strerror(errno) : "the write failed");
}

Pixels readExr(const std::filesystem::path& file, const Accept& accept) {
  const std::vector<uint8_t> bytes = readBytes(file);
  EXRVersion version;
  if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS)
    fail("it is no EXR file");
  if (version.multipart || version.non_image || version.tiled)
    fail("only EXR files with one part of scan lines are supported");
  Exr exr;
  const char* message = nullptr;
  if (ParseEXRHeaderFromMemory(&exr.header, &version, bytes.data(), bytes.size(), &message) !=
      TINYEXR_SUCCESS)
    fail(reasonOf(message));
  exr.owned = true;
  const EXRBox2i& window = exr.header.data_window;
  checkSize(int64_t(window.max_x) - window.min_x + 1, int64_t(window.max_y) - window.min_y + 1);
  accept(uint32_t(int64_t(window.max_x) - window.min_x + 1),
         uint32_t(int64_t(window.max_y) - window.min_y + 1), size_t(exr.header.num_channels));
  for (int c = 0; c < exr.header.num_channels; ++c)
    if (exr.header.pixel_types[c] !=
        TINYEXR_PIXELTYPE_UINT)  // which it cannot convert; they are left out later
      exr.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  if (LoadEXRImageFromMemory(&exr.image, &exr.header, bytes.data(), bytes.size(), &message) !=
      TINYEXR_SUCCESS)
    fail(reasonOf(message));
  const size_t channels = size_t(exr.image.num_channels), count = size_t(exr.image.width) * exr.image.height;
  Pixels pixels{
      uint32_t(exr.image.width), uint32_t(exr.image.height), {}, std::vector<float>(count * channels), {}};
  for (size_t c = 0; c < channels; ++c) {
    pixels.channels.push_back(exr.header.channels[c].name);
    const float* plane = reinterpret_cast<const float*>(exr.image.images[c]);
    for (size_t i = 0; i < count; ++i) pixels.data[i * channels + c] = plane[i];
  }
  for (int a = 0; a < exr.header.num_custom_attributes; ++a) {
    const EXRAttribute& attribute = exr.header.custom_attributes[a];
    if (std::strcmp(attribute.type, "string") == 0)
      pixels.metadata[attribute.name] = {reinterpret_cast<const char*>(attribute.value),
                                         size_t(attribute.size)};
  }
  return pixels;
}

// ---- PNG ---------------------------------------------------------------------------------------------------------

// libpng reports errors through a callback that must not return. An exception passes through its C code, which Debian
// builds with unwind tables, as all amd64 and arm64 libraries are.
[[noreturn]] void onPngError(png_structp, png_const_charp message) { fail(message); }
void onPngWarning(png_structp, png_const_charp) {}

struct Png {
  png_structp png = nullptr;
  png_infop info = nullptr;
  bool writing;
  std::unique_ptr<FILE, int (*)(FILE*)> stream;
  Png(const std::filesystem::path& file, bool write)
      : writing(write), stream(std::fopen(file.c_str(), write ? "wb" : "rb"), std::fclose) {
    if (!stream) fail(std::strerror(errno));
    png = write ? png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, onPngError, onPngWarning)
                : png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, onPngError, onPngWarning);
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) fail("libpng cannot start");
    png_init_io(png, stream.get());
  }
  ~Png() { writing ? png_destroy_write_struct(&png, &info) : png_destroy_read_struct(&png, &info, nullptr); }
};

void writePng(const std::filesystem::path& file, const Pixels& pixels) {
  static constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                   PNG_COLOR_TYPE_RGB_ALPHA};
  const size_t channels = pixels.channels.size();
  Png png(file, true);
  png_set_IHDR(png.png, png.info, pixels.width, pixels.height, 8, kTypes[channels - 1], PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png.png, png.info, PNG_sRGB_INTENT_PERCEPTUAL);
  std::vector<png_text> texts;
  for (const auto& [key, value] : pixels.metadata) {
    png_text& text = texts.emplace_back();
    text.compression = PNG_ITXT_COMPRESSION_NONE;  // UTF-8
    text.key = const_cast<char*>(key.c_str());
    text.text = const_cast<char*>(value.c_str());
    text.lang = text.lang_key = const_cast<char*>("");
  }
  png_set_text(png.png, png.info, texts.data(), int(texts.size()));
  png_write_info(png.png, png.info);
  std::vector<uint8_t> row(pixels.width * channels);
  for (size_t y = 0; y < pixels.height; ++y) {
    for (size_t i = 0; i < row.size(); ++i)
      row[i] = uint8_t(std::lround(pixels.data[y * row.size() + i] * 255));
    png_write_row(png.png, row.data());
  }
  png_write_end(png.png, png.info);
  if (std::fflush(png.stream.get()) != 0) fail(std::strerror(errno));
}

Pixels readPng(const std::filesystem::path& file, const Accept& accept) {
  static const std::vector<std::string> kNames[] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  Png png(file, false);
  png_read_info(png.png, png.info);
  png_set_expand(png.png);
  png_set_scale_16(png.png);
  png_set_interlace_handling(png.png);
  png_read_update_info(png.png, png.info);
  const uint32_t width = png_get_image_width(png.png, png.info),
                 height = png_get_image_height(png.png, png.info);
  checkSize(width, height);
  accept(width, height, png_get_channels(png.png, png.info));
  const size_t rowBytes = png_get_rowbytes(png.png, png.info);
  std::vector<uint8_t> bytes(rowBytes * height);
  std::vector<png_bytep> rows(height);
  for (size_t y = 0; y < height; ++y) rows[y] = &bytes[y * rowBytes];
  png_read_image(png.png, rows.data());
  png_read_end(png.png, png.info);
  Pixels pixels{width, height, kNames[png_get_channels(png.png, png.info) - 1], {}, {}};
  pixels.data.resize(bytes.size());
  std::transform(bytes.begin(), bytes.end(), pixels.data.begin(), [](uint8_t v) { return float(v) / 255; });
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(png.png, png.info, &texts, &count);
  for (int i = 0; i < count; ++i) pixels.metadata[texts[i].key] = texts[i].text;
  return pixels;
}

void write(const std::filesystem::path& file, const Pixels& pixels) {
  errno = 0;
  file.extension() == ".png" ? writePng(file, pixels) : writeExr(file, pixels);
}

Image8 decode8(const uint8_t* bytes, size_t size, const Accept& accept) {
  int width = 0, height = 0, channels = 0;
  if (size > size_t(INT32_MAX)) fail("it has more than 2 GiB");
  if (!stbi_info_from_memory(bytes, int(size), &width, &height, &channels)) fail(stbi_failure_reason());
  checkSize(width, height);
  accept(uint32_t(width), uint32_t(height), size_t(channels));
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(bytes, int(size), &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) fail(stbi_failure_reason());
  return {uint32_t(width), uint32_t(height), {pixels.get(), pixels.get() + size_t(width) * height * 4}};
}

// The format is recognised by content; the name may be anything.
Pixels read(const std::filesystem::path& file, uint32_t, const Accept& accept) {
  uint8_t magic[8] = {};
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(magic), sizeof(magic));
  if (png_sig_cmp(magic, 0, sizeof(magic)) == 0) return readPng(file, accept);
  if (magic[0] == 0x76 && magic[1] == 0x2f) return readExr(file, accept);
  const std::vector<uint8_t> bytes = readBytes(file);
  const Image8 image = decode8(bytes.data(), bytes.size(), accept);
  Pixels pixels{image.width, image.height, {"R", "G", "B", "A"}, std::vector<float>(image.rgba.size()), {}};
  std::transform(image.rgba.begin(), image.rgba.end(), pixels.data.begin(),
                 [](uint8_t v) { return float(v) / 255; });
  return pixels;
}

}  // namespace

const Library& library() {
  static constexpr Library kSmall{write, read, decode8};
  return kSmall;
}

}  // namespace fovea::image::codec
