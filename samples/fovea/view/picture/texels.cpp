#include "samples/fovea/view/picture/texels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <span>

#include "framework/gpu/format.h"

namespace fovea::view {
namespace {

using gpu::FormatInfo;

constexpr uint32_t kMostWords = 64;  // of an element of a buffer that are shown

uint32_t wordOf(float value) {
  uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  return word;
}

float floatOf(uint32_t word) {
  float value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

template <class T>
T read(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// Formats whose channels share a word. Texels of others may have fewer bytes.
bool packedWords(const FormatInfo& format, const std::byte* texel, uint32_t* out) {
  if (format.bytesPerTexel != 4) return false;
  const auto word = read<uint32_t>(texel);
  switch (format.format) {
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32: {
      const glm::vec3 v = glm::unpackF2x11_1x10(word);
      for (int c = 0; c < 3; ++c) out[c] = wordOf(v[c]);
      return true;
    }
    case VK_FORMAT_E5B9G9R9_UFLOAT_PACK32: {
      const float scale = std::ldexp(1.0f, int(word >> 27) - 24);
      for (int c = 0; c < 3; ++c) out[c] = wordOf(float(word >> (9 * c) & 511u) * scale);
      return true;
    }
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32: {
      const glm::vec4 v = glm::unpackUnorm3x10_1x2(word);
      for (int c = 0; c < 4; ++c) out[c] = wordOf(v[c]);
      return true;
    }
    case VK_FORMAT_A2B10G10R10_UINT_PACK32:
      for (int c = 0; c < 3; ++c) out[c] = word >> (10 * c) & 1023u;
      out[3] = word >> 30;
      return true;
    default:
      return false;
  }
}

uint32_t channelWord(FormatInfo::Type type, uint32_t bytes, const std::byte* at) {
  switch (type) {
    case FormatInfo::Type::Float:
      return bytes == 2 ? wordOf(glm::unpackHalf1x16(read<uint16_t>(at))) : read<uint32_t>(at);
    case FormatInfo::Type::Unorm:
    case FormatInfo::Type::Srgb:
      return wordOf(bytes == 1 ? float(read<uint8_t>(at)) / 255.0f : float(read<uint16_t>(at)) / 65535.0f);
    case FormatInfo::Type::Snorm:
      return wordOf(bytes == 1 ? std::max(-1.0f, float(read<int8_t>(at)) / 127.0f)
                               : std::max(-1.0f, float(read<int16_t>(at)) / 32767.0f));
    case FormatInfo::Type::Uint:
      return bytes == 1 ? read<uint8_t>(at) : bytes == 2 ? read<uint16_t>(at) : read<uint32_t>(at);
    case FormatInfo::Type::Sint:
      return bytes == 1   ? uint32_t(int32_t(read<int8_t>(at)))
             : bytes == 2 ? uint32_t(int32_t(read<int16_t>(at)))
                          : read<uint32_t>(at);
  }
  return 0;
}

void texelWords(const FormatInfo& format, const std::byte* texel, uint32_t* out) {
  if (packedWords(format, texel, out)) return;
  const uint32_t bytes = format.bytesPerTexel / format.channels;
  for (uint32_t c = 0; c < format.channels; ++c) out[c] = channelWord(format.type, bytes, texel + c * bytes);
  if (format.name.starts_with("bgra")) std::swap(out[0], out[2]);
}

}  // namespace

Layout layoutOf(const graph::ResourceDesc& desc) {
  if (desc.kind == graph::ResourceKind::Buffer)
    return {Layout::Type::Float, uint32_t(desc.count), 1, std::clamp(desc.stride / 4, 1u, kMostWords), false};
  const FormatInfo& format = gpu::formatInfo(desc.format);
  const bool encoded = (format.type == FormatInfo::Type::Unorm || format.type == FormatInfo::Type::Srgb) &&
                       !format.depth && format.channels >= 3;
  const auto type = format.type == FormatInfo::Type::Uint   ? Layout::Type::Unsigned
                    : format.type == FormatInfo::Type::Sint ? Layout::Type::Signed
                                                            : Layout::Type::Float;
  return {type, desc.width, desc.height, format.channels, encoded};
}

Region wholeOf(const Layout& layout) { return {0, 0, layout.width, layout.height}; }

std::vector<uint32_t> words(const graph::OutputData& data, const Region& region) {
  const Layout layout = layoutOf(data.desc);
  std::vector<uint32_t> out(size_t(region.width) * region.height * layout.channels);
  const bool buffer = data.desc.kind == graph::ResourceKind::Buffer;
  const size_t stride = buffer ? data.desc.stride : gpu::formatInfo(data.desc.format).bytesPerTexel;
  uint32_t* at = out.data();
  for (uint32_t row = region.y; row < region.y + region.height; ++row) {
    for (uint32_t column = region.x; column < region.x + region.width; ++column, at += layout.channels) {
      const std::byte* texel = data.bytes.data() + (size_t(row) * layout.width + column) * stride;
      if (buffer)
        std::memcpy(at, texel, std::min<size_t>(stride, size_t(layout.channels) * 4));
      else
        texelWords(gpu::formatInfo(data.desc.format), texel, at);
    }
  }
  return out;
}

std::vector<float> numbers(const graph::OutputData& data, const Region& region) {
  const Layout layout = layoutOf(data.desc);
  const std::vector<uint32_t> all = words(data, region);
  std::vector<float> out(all.size());
  for (size_t i = 0; i < all.size(); ++i)
    out[i] = layout.type == Layout::Type::Float      ? floatOf(all[i])
             : layout.type == Layout::Type::Unsigned ? float(all[i])
                                                     : float(int32_t(all[i]));
  return out;
}

std::vector<float> numbers(const graph::OutputData& data) {
  return numbers(data, wholeOf(layoutOf(data.desc)));
}

std::vector<ChannelStatistics> statistics(const graph::OutputData& data, const Region& region) {
  const std::vector<float> values = numbers(data, region);
  const uint32_t channels = std::max(1u, layoutOf(data.desc).channels);
  std::vector<ChannelStatistics> all(channels);
  for (size_t i = 0; i < values.size(); ++i) {
    ChannelStatistics& c = all[i % channels];
    const float v = values[i];
    if (std::isnan(v)) ++c.nan;
    if (std::isinf(v)) ++c.infinite;
    if (!std::isfinite(v)) continue;
    c.min = c.finite ? std::min(c.min, v) : v;
    c.max = c.finite ? std::max(c.max, v) : v;
    c.mean += double(v);
    ++c.finite;
  }
  for (ChannelStatistics& c : all) c.mean /= double(std::max<uint64_t>(1, c.finite));
  for (size_t i = 0; i < values.size(); ++i) {
    ChannelStatistics& c = all[i % channels];
    if (!std::isfinite(values[i])) continue;
    const double width = double(c.max) - double(c.min);
    const double place = width > 0 ? (double(values[i]) - double(c.min)) / width : 0;
    ++c.histogram[std::min(c.histogram.size() - 1, size_t(place * double(c.histogram.size())))];
  }
  return all;
}

}  // namespace fovea::view
