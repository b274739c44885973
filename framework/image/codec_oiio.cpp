#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "framework/image/codec.h"

namespace fovea::image::codec {

namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw std::runtime_error(reason.empty() ? "the image library gives no reason" : reason);
}

// Reads pixels as they are stored; by default OpenImageIO multiplies PNG colours by alpha.
OIIO::ImageSpec readConfig() {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  return config;
}

void checkSize(const OIIO::ImageSpec& spec) {
  if (spec.width < 1 || spec.height < 1 || spec.width > int(kMaxSide) || spec.height > int(kMaxSide))
    fail("its size " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
         " is not within 1x1 and 32768x32768");
  if (spec.nchannels < 1 || spec.nchannels > 1024)
    fail("it has " + std::to_string(spec.nchannels) + " channels");
  if (spec.deep || spec.depth > 1) fail("deep and volume images are not supported");
}

// Opens a picture in the format that its first bytes indicate. Left to itself, OpenImageIO tries all its plug-ins on
// what it does not know, among them decoders of videos and of medical images.
std::unique_ptr<OIIO::ImageInput> open(std::string_view begin, const std::string& name,
                                       const OIIO::ImageSpec& config) {
  static constexpr std::pair<std::string_view, const char*> kFormats[] = {
      {"\x89PNG", "png"}, {"\x76\x2f\x31\x01", "openexr"}, {"\xff\xd8\xff", "jpeg"}, {"#?", "hdr"}};
  for (const auto& [magic, format] : kFormats) {
    if (!begin.starts_with(magic)) continue;
    auto input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec spec;
    if (!input) fail(OIIO::geterror());
    if (!input->open(name, spec, config)) fail(input->geterror());
    return input;
  }
  fail("it is no EXR, PNG, JPEG or HDR file");
}

void write(const std::filesystem::path& file, const Pixels& pixels) {
  const bool png = file.extension() == ".png";
  auto output = OIIO::ImageOutput::create(file.string());
  if (!output) fail(OIIO::geterror());
  OIIO::ImageSpec spec(int(pixels.width), int(pixels.height), int(pixels.channels.size()),
                       png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
  spec.channelnames = pixels.channels;
  if (png) {
    spec["oiio:UnassociatedAlpha"] = 1;
    spec["oiio:ColorSpace"] = "sRGB";
  } else {
    spec["compression"] = "zip";
    spec["DateTime"] = "";  // else the time of day, and no two files of the same picture would be equal
  }
  for (const auto& [key, value] : pixels.metadata) spec.attribute(key, value);
  const bool written =
      output->open(file.string(), spec) && output->write_image(OIIO::TypeDesc::FLOAT, pixels.data.data());
  const bool closed = output->close();
  if (!written || !closed || output->has_error()) fail(output->geterror());
}

Pixels read(const std::filesystem::path& file, uint32_t part, const Accept& accept) {
  char begin[4] = {};
  std::ifstream(file, std::ios::binary).read(begin, sizeof(begin));
  const auto input = open({begin, sizeof(begin)}, file.string(), readConfig());
  if (!input->seek_subimage(int(part), 0)) fail(input->geterror());
  const OIIO::ImageSpec spec = input->spec();
  checkSize(spec);
  accept(uint32_t(spec.width), uint32_t(spec.height), size_t(spec.nchannels));
  Pixels pixels;
  pixels.width = uint32_t(spec.width);
  pixels.height = uint32_t(spec.height);
  pixels.channels = spec.channelnames;
  pixels.data.resize(size_t(spec.width) * spec.height * spec.nchannels);
  if (!input->read_image(int(part), 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data.data()))
    fail(input->geterror());
  for (const OIIO::ParamValue& value : spec.extra_attribs)
    if (value.type() == OIIO::TypeDesc::STRING) pixels.metadata[value.name().string()] = value.get_string();
  input->close();
  return pixels;
}

Image8 decode8(const uint8_t* bytes, size_t size, const Accept& accept) {
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes), size);
  OIIO::ImageSpec config = readConfig();
  void* proxy = &memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  const auto input = open({reinterpret_cast<const char*>(bytes), size}, "memory", config);
  const OIIO::ImageSpec spec = input->spec();
  checkSize(spec);
  const size_t count = size_t(spec.width) * spec.height;
  const size_t channels = size_t(spec.nchannels);
  accept(uint32_t(spec.width), uint32_t(spec.height), channels);
  std::vector<uint8_t> stored(count * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, stored.data()))
    fail(input->geterror());
  Image8 image{uint32_t(spec.width), uint32_t(spec.height), std::vector<uint8_t>(count * 4)};
  for (size_t i = 0; i < count; ++i) {
    const uint8_t* from = &stored[i * channels];
    uint8_t* to = &image.rgba[i * 4];
    for (size_t c = 0; c < 3; ++c) to[c] = channels >= 3 ? from[c] : from[0];
    to[3] = channels == 4 ? from[3] : channels == 2 ? from[1] : 255;
  }
  return image;
}

constexpr Library kOpenImageIO{write, read, decode8};

}  // namespace
}  // namespace fovea::image::codec

// What codec_load.cpp asks for.
extern "C" const fovea::image::codec::Library* fovea_image_library() {
  return &fovea::image::codec::kOpenImageIO;
}
