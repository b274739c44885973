#include "fovea/image.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "fovea/error.h"
#include "framework/base/budget.h"
#include "framework/base/files.h"
#include "framework/base/threads.h"
#include "framework/image/codec.h"
#include "framework/image/header.h"
#include "framework/image/pfm.h"

namespace fovea::image {

namespace fs = std::filesystem;
using codec::Pixels;

namespace {

constexpr std::string_view kPrefix = "fovea.";  // of metadata keys in files

std::string extensionOf(const fs::path& file) {
  std::string e = file.extension().string();
  if (!e.empty()) e.erase(0, 1);
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return e;
}

// The extension, after checking that it is writable.
std::string checkExtension(const fs::path& file) {
  const std::string extension = extensionOf(file);
  const std::vector<std::string> known = writableExtensions();
  if (std::find(known.begin(), known.end(), extension) != known.end()) return extension;
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "." : ", .") + k;
  throw Error(ExitCode::BadInput,
              "`" + file.string() + "`: " +
                  (extension.empty() ? "the name has no extension"
                                     : "the image format `." + extension + "` is not known"),
              "name the file with one of " + list);
}

[[noreturn]] void cannotWrite(const fs::path& file, const std::string& reason) {
  const std::string first = reason.substr(0, reason.find('\n'));  // libraries repeat themselves
  throw Error(ExitCode::CannotWrite, "cannot write `" + file.string() + "`: " + first,
              "choose a folder that exists, is writable and has room");
}

// ---- Layers <-> channels -----------------------------------------------------------------------------------------

std::string channelName(uint32_t channel, uint32_t channels) {
  if (channels == 1) return "Y";
  if (channels <= 4) return std::string(1, "RGBA"[channel]);
  std::string digits = std::to_string(channel);
  return "c" + std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
}

void checkLayers(const fs::path& file, const std::vector<Layer>& layers, bool many) {
  auto bad = [&](const std::string& message, const std::string& remedy) {
    throw Error(ExitCode::BadInput, "`" + file.string() + "`: " + message, remedy);
  };
  if (layers.empty()) bad("there is nothing to write", "give at least one layer");
  if (!many && layers.size() > 1)
    bad("this format holds one layer, not " + std::to_string(layers.size()),
        "write an .exr, or one file a layer");
  for (const Layer& layer : layers) {
    const Image& image = layer.image;
    const std::string name = "layer `" + layer.name + "` ";
    if (image.width == 0 || image.height == 0 || image.channels == 0) bad(name + "is empty", "");
    if (image.data.size() != size_t(image.width) * image.height * image.channels)
      bad(name + "has " + std::to_string(image.data.size()) + " values, not width x height x channels", "");
    if (image.width != layers[0].image.width || image.height != layers[0].image.height)
      bad(name + "differs in size from layer `" + layers[0].name + "`", "write them to files of their own");
    const auto same = [&](const Layer& other) { return other.name == layer.name; };
    if (std::count_if(layers.begin(), layers.end(), same) > 1) bad(name + "is there twice", "");
    if (layer.name.size() > 200) bad(name + "has a name of more than 200 characters", "");
  }
}

// Puts channels in alphabetical order, as EXR files keep them.
Pixels toPixels(const std::vector<Layer>& layers, const Metadata& metadata) {
  struct Source {
    std::string name;
    const Image* image;
    uint32_t channel;
  };
  std::vector<Source> sources;
  for (const Layer& layer : layers)
    for (uint32_t c = 0; c < layer.image.channels; ++c)
      sources.push_back({(layer.name.empty() ? "" : layer.name + ".") + channelName(c, layer.image.channels),
                         &layer.image, c});
  // A single layer keeps its own order, on which one-layer formats rely.
  if (layers.size() > 1)
    std::sort(sources.begin(), sources.end(),
              [](const Source& a, const Source& b) { return a.name < b.name; });
  Pixels pixels{layers[0].image.width, layers[0].image.height, {}, {}, {}};
  for (const Source& s : sources) pixels.channels.push_back(s.name);
  const size_t count = size_t(pixels.width) * pixels.height;
  const size_t stride = sources.size();
  pixels.data.resize(count * stride);
  for (size_t c = 0; c < stride; ++c)
    for (size_t i = 0; i < count; ++i)
      pixels.data[i * stride + c] =
          sources[c].image->data[i * sources[c].image->channels + sources[c].channel];
  for (const auto& [key, value] : metadata)
    if (!value.empty()) pixels.metadata[std::string(kPrefix) + key] = value;
  return pixels;
}

int channelRank(const std::string& name) {
  const size_t rank = std::string_view("RGBXYZA").find(name);
  return name.size() == 1 && rank != std::string_view::npos ? int(rank) : 100;
}

File toFile(const Pixels& pixels) {
  File file;
  std::vector<std::vector<std::pair<std::string, size_t>>> groups;  // per layer: channel name, index
  for (size_t c = 0; c < pixels.channels.size(); ++c) {
    const std::string& full = pixels.channels[c];
    const size_t dot = full.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : full.substr(0, dot);
    const std::string channel = dot == std::string::npos ? full : full.substr(dot + 1);
    size_t g = 0;
    while (g < file.layers.size() && file.layers[g].name != layer) ++g;
    if (g == file.layers.size()) {
      file.layers.push_back({layer, {}});
      groups.emplace_back();
    }
    groups[g].emplace_back(channel, c);
  }
  const size_t count = size_t(pixels.width) * pixels.height;
  for (size_t g = 0; g < groups.size(); ++g) {
    std::stable_sort(groups[g].begin(), groups[g].end(), [](const auto& a, const auto& b) {
      return channelRank(a.first) < channelRank(b.first);
    });
    const size_t channels = groups[g].size();
    Image image{pixels.width, pixels.height, uint32_t(channels), std::vector<float>(count * channels)};
    for (size_t c = 0; c < channels; ++c)
      for (size_t i = 0; i < count; ++i)
        image.data[i * channels + c] = pixels.data[i * pixels.channels.size() + groups[g][c].second];
    file.layers[g].image = std::move(image);
  }
  for (const auto& [key, value] : pixels.metadata)
    if (key.starts_with(kPrefix)) file.metadata[key.substr(kPrefix.size())] = value;
  return file;
}

// Rounds 0..1 to the nearest of 256 steps. A pixel with a NaN becomes magenta, so that a defect is visible.
void quantise(Pixels& pixels) {
  const size_t channels = pixels.channels.size();
  static constexpr float kMagenta[4] = {1, 0, 1, 1};
  for (size_t i = 0; i < pixels.data.size(); i += channels) {
    float* pixel = &pixels.data[i];
    if (std::any_of(pixel, pixel + channels, [](float v) { return std::isnan(v); }))
      for (size_t c = 0; c < channels; ++c) pixel[c] = kMagenta[c];
    for (size_t c = 0; c < channels; ++c) pixel[c] = std::round(std::clamp(pixel[c], 0.0f, 1.0f) * 255) / 255;
  }
}

// ---- Writing -----------------------------------------------------------------------------------------------------

// Describes how a file differs from what was written, because of a full disk or a defect of a library.
std::string difference(const Pixels& wanted, const Pixels& found, bool eightBit, bool metadata) {
  if (wanted.width != found.width || wanted.height != found.height) return "its size";
  if (wanted.channels.size() != found.channels.size()) return "its channels";
  const size_t channels = wanted.channels.size();
  for (size_t c = 0; c < channels; ++c) {
    const auto same = std::find(found.channels.begin(), found.channels.end(), wanted.channels[c]);
    const size_t d = eightBit ? c : size_t(same - found.channels.begin());
    if (d == channels) return "channel " + wanted.channels[c];
    for (size_t i = 0; i < wanted.data.size(); i += channels) {
      const float a = wanted.data[i + c], b = found.data[i + d];
      const bool equal = eightBit ? std::abs(a - b) < 1e-4f
                                  : std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) ||
                                        (std::isnan(a) && std::isnan(b));
      if (!equal) return "pixel " + std::to_string(i / channels) + " of channel " + wanted.channels[c];
    }
  }
  for (const auto& [key, value] : wanted.metadata) {
    const auto entry = found.metadata.find(key);
    if (metadata && (entry == found.metadata.end() || entry->second != value)) return "metadata " + key;
  }
  return {};
}

void writeChecked(const fs::path& temporary, const std::string& extension, const Pixels& pixels) {
  const bool pfm = extension == "pfm";
  pfm ? writePfm(temporary, pixels) : codec::library().write(temporary, pixels);
  const Pixels back =
      pfm ? readPfm(temporary) : codec::library().read(temporary, [](uint32_t, uint32_t, size_t) {});
  const std::string part = difference(pixels, back, extension == "png", !pfm);
  if (!part.empty()) throw std::runtime_error(part + " reads back different from what was written");
}

std::string withDiskSpace(const std::string& reason, const fs::path& file, size_t bytes) {
  std::error_code failed;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const fs::space_info space = fs::space(folder, failed);
  if (failed || space.available >= bytes) return reason;
  return "the disk is full (" + std::to_string(space.available / 1024) + " KiB free): " + reason;
}

}  // namespace

const Image* File::find(std::string_view layer) const {
  for (const Layer& l : layers)
    if (l.name == layer) return &l.image;
  return nullptr;
}

std::vector<std::string> writableExtensions() {
  std::vector<std::string> list(std::begin(codec::kExtensions), std::end(codec::kExtensions));
  list.push_back("pfm");
  return list;
}

void checkWritable(const fs::path& file) {
  checkExtension(file);
  codec::library();  // loaded now, neither after the work nor between frames
  if (const std::string reason = whyUnwritable(file); !reason.empty()) cannotWrite(file, reason);
}

void write(const fs::path& file, const std::vector<Layer>& layers, const Metadata& metadata) {
  const std::string extension = checkExtension(file);
  checkLayers(file, layers, extension == "exr");
  checkWritable(file);
  Pixels pixels = toPixels(layers, metadata);
  if (extension != "exr") {
    const size_t channels = pixels.channels.size();
    if (extension == "png" ? channels > 4 : channels != 1 && channels != 3)
      throw Error(
          ExitCode::BadInput,
          "`" + file.string() + "`: ." + extension + " cannot hold " + std::to_string(channels) + " channels",
          "write an .exr");
    for (size_t c = 0; c < channels; ++c) pixels.channels[c] = channelName(uint32_t(c), uint32_t(channels));
    if (channels == 2) pixels.channels = {"Y", "A"};
  }
  if (extension == "png") quantise(pixels);
  try {
    OutputFile output(file);
    writeChecked(output.temporary(), extension, pixels);
    output.finish();
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::OutOfMemory, "not enough memory to write `" + file.string() + "`");
  } catch (const std::exception& e) {
    throwIfNoThreads();
    const size_t room = extension == "png" ? pixels.data.size() / 64 + 4096 : pixels.data.size() + 4096;
    cannotWrite(file, withDiskSpace(e.what(), file, room));
  }
}

// ---- Reading -----------------------------------------------------------------------------------------------------

namespace {

[[noreturn]] void cannotRead(const std::string& name, const std::string& reason) {
  throw Error(ExitCode::BadInput, "cannot read image `" + name + "`: " + reason);
}

[[noreturn]] void noMemoryFor(const std::string& name) {
  throw Error(ExitCode::OutOfMemory, "not enough memory to read image `" + name + "`", "make it smaller");
}

// The library's own message for a missing file is often about formats.
void checkReadable(const fs::path& file) {
  if (const std::string reason = whyUnreadable(file); !reason.empty()) cannotRead(file.string(), reason);
  noteRead(file);
}

bool startsAsExr(std::istream& stream) {
  char magic[4] = {};
  return stream.read(magic, sizeof(magic)) && std::memcmp(magic, "\x76\x2f\x31\x01", sizeof(magic)) == 0;
}

// What a header claims is refused before it is decoded.
codec::Accept acceptor(const fs::path& file) {
  return [file](uint32_t width, uint32_t height, size_t channels) {
    const uint64_t values = uint64_t(width) * height * channels;
    if (const std::string reason = whyTooPlain(values / 3, fs::file_size(file)); !reason.empty())
      cannotRead(file.string(), reason);
    claimContent(values * 2 * sizeof(float), "image `" + file.string() + "`");
  };
}

}  // namespace

File read(const fs::path& file) {
  checkReadable(file);
  try {
    if (std::ifstream stream(file, std::ios::binary); startsAsExr(stream))
      if (const std::string reason = whyForged(stream); !reason.empty()) cannotRead(file.string(), reason);
    return toFile(extensionOf(file) == "pfm" ? readPfm(file) : codec::library().read(file, acceptor(file)));
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    noMemoryFor(file.string());
  } catch (const std::exception& e) {
    cannotRead(file.string(), e.what());
  }
}

Image8 read8(const fs::path& file) {
  checkReadable(file);
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  return decode8(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), file.string());
}

Image8 decode8(const uint8_t* bytes, size_t size, const std::string& name) {
  const bool png = size >= 8 && std::memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0;
  const bool jpeg = size >= 3 && std::memcmp(bytes, "\xff\xd8\xff", 3) == 0;
  if (!png && !jpeg) cannotRead(name, size == 0 ? "it is empty" : "it is neither PNG nor JPEG");
  // Those who decode many pictures have counted what their headers claim.
  const HeaderSize claimed = headerSize({bytes, size}).value_or(HeaderSize{});
  const auto accept = [&](uint32_t width, uint32_t height, size_t) {
    if (width != claimed.width || height != claimed.height) cannotRead(name, "its header is broken");
  };
  try {
    return codec::library().decode8(bytes, size, accept);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    noMemoryFor(name);
  } catch (const std::exception& e) {
    cannotRead(name, e.what());
  }
}

}  // namespace fovea::image
