#include "fovea/image.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
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

// Appends the layers of one part, or of the whole file. `nameOf` gives a layer of the file its name.
void addLayers(File& file, const Pixels& pixels,
               const std::function<std::string(const std::string&)>& nameOf) {
  const size_t first = file.layers.size();
  std::vector<std::vector<std::pair<std::string, size_t>>> groups;  // per layer: channel name, index
  for (size_t c = 0; c < pixels.channels.size(); ++c) {
    const std::string& full = pixels.channels[c];
    const size_t dot = full.rfind('.');
    const std::string layer = nameOf(dot == std::string::npos ? "" : full.substr(0, dot));
    const std::string channel = dot == std::string::npos ? full : full.substr(dot + 1);
    size_t g = 0;
    while (g < groups.size() && file.layers[first + g].name != layer) ++g;
    if (g == groups.size()) {
      if (file.findLayer(layer)) throw std::runtime_error("two of its parts have a layer `" + layer + "`");
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
    Layer& layer = file.layers[first + g];
    layer.image = {pixels.width, pixels.height, uint32_t(channels), std::vector<float>(count * channels)};
    for (size_t c = 0; c < channels; ++c) {
      layer.channels.push_back(groups[g][c].first);
      for (size_t i = 0; i < count; ++i)
        layer.image.data[i * channels + c] = pixels.data[i * pixels.channels.size() + groups[g][c].second];
    }
  }
  for (const auto& [key, value] : pixels.metadata)
    if (key.starts_with(kPrefix)) file.metadata.emplace(key.substr(kPrefix.size()), value);
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
      pfm ? readPfm(temporary) : codec::library().read(temporary, 0, [](uint32_t, uint32_t, size_t) {});
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

const Layer* File::findLayer(std::string_view layer) const {
  for (const Layer& l : layers)
    if (l.name == layer) return &l;
  return nullptr;
}

const Image* File::find(std::string_view layer) const {
  const Layer* found = findLayer(layer);
  return found ? &found->image : nullptr;
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

bool startsAsHdr(std::istream& stream) {
  stream.clear();
  stream.seekg(0);
  return stream.get() == '#' && stream.get() == '?';
}

// Why the pixels of a part cannot be read as an image, or "".
std::string whyUnread(const ExrPart& part) {
  if (part.deep) return "it is deep: its pixels have several samples each";
  for (const ExrPart::Channel& c : part.channels) {
    if (c.xSampling != 1 || c.ySampling != 1)
      return "its channel `" + c.name + "` has one sample for " + std::to_string(c.xSampling) + "x" +
             std::to_string(c.ySampling) + " pixels";
    const std::string last = c.name.substr(c.name.rfind('.') + 1);
    if (last == "RY" || last == "BY") return "it has luminance and chroma in place of red, green and blue";
  }
  return {};
}

// Moves the channels that hold integers, which identify things and are no light, to `unread`.
void leaveOutIntegers(Pixels& pixels, const ExrPart& part, const std::function<void(std::string)>& leaveOut) {
  const size_t count = pixels.channels.size();
  std::vector<size_t> kept;
  for (size_t c = 0; c < count; ++c) {
    const auto same = [&](const ExrPart::Channel& channel) { return channel.name == pixels.channels[c]; };
    const auto found = std::find_if(part.channels.begin(), part.channels.end(), same);
    if (found != part.channels.end() && found->integers)
      leaveOut(found->name);
    else
      kept.push_back(c);
  }
  if (kept.size() == count) return;
  const size_t texels = size_t(pixels.width) * pixels.height;
  for (size_t i = 0; i < texels; ++i)
    for (size_t k = 0; k < kept.size(); ++k)
      pixels.data[i * kept.size() + k] = pixels.data[i * count + kept[k]];
  pixels.data.resize(texels * kept.size());
  std::vector<std::string> names;
  for (const size_t c : kept) names.push_back(std::move(pixels.channels[c]));
  pixels.channels = std::move(names);
}

// The name of a layer of one of several parts.
std::string nameInPart(const std::string& part, const std::string& layer) {
  if (layer.empty()) return part;
  return layer == part || layer.starts_with(part + ".") ? layer : part + "." + layer;
}

File readExr(const fs::path& path, const std::vector<ExrPart>& parts) {
  File file;
  for (size_t i = 0; i < parts.size(); ++i) {
    const ExrPart& part = parts[i];
    const auto nameOf = [&](const std::string& layer) {
      return parts.size() > 1 ? nameInPart(part.name, layer) : layer;
    };
    if (const std::string reason = whyUnread(part); !reason.empty()) {
      file.unread.push_back({part.name, reason});
      continue;
    }
    Pixels pixels = codec::library().read(path, uint32_t(i), acceptor(path));
    leaveOutIntegers(pixels, part, [&](const std::string& channel) {
      const size_t dot = channel.rfind('.');
      const std::string layer = nameOf(dot == std::string::npos ? "" : channel.substr(0, dot));
      file.unread.push_back(
          {layer.empty() ? channel : layer, "its channel `" + channel + "` holds integers"});
    });
    const size_t first = file.layers.size();
    addLayers(file, pixels, nameOf);
    for (size_t l = first; l < file.layers.size(); ++l) {
      file.layers[l].display = part.display;
      file.layers[l].data = {part.data.x, part.data.y, pixels.width, pixels.height};
    }
  }
  if (file.layers.empty()) cannotRead(path.string(), file.unread.at(0).reason);
  file.radiance = true;
  return file;
}

}  // namespace

File read(const fs::path& file) {
  checkReadable(file);
  try {
    std::ifstream stream(file, std::ios::binary);
    if (startsAsExr(stream)) {
      if (const std::string reason = whyForged(stream); !reason.empty()) cannotRead(file.string(), reason);
      if (const std::vector<ExrPart> parts = exrParts(stream); !parts.empty()) return readExr(file, parts);
    }
    const bool pfm = extensionOf(file) == "pfm";
    File plain;
    addLayers(plain, pfm ? readPfm(file) : codec::library().read(file, 0, acceptor(file)),
              [](const std::string& layer) { return layer; });
    plain.radiance = pfm || startsAsHdr(stream);
    return plain;
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
