#include "framework/gpu/format.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <string>

#include "fovea/error.h"

namespace fovea::gpu {
namespace {

using T = FormatInfo::Type;

// Names as in GLSL layout qualifiers; formats without one (sRGB, depth) follow the same pattern.
constexpr FormatInfo kFormats[] = {
    {VK_FORMAT_R8_UNORM, "r8", 1, 1, false, T::Unorm},
    {VK_FORMAT_R8G8_UNORM, "rg8", 2, 2, false, T::Unorm},
    {VK_FORMAT_R8G8B8A8_UNORM, "rgba8", 4, 4, false, T::Unorm},
    {VK_FORMAT_R8_SNORM, "r8_snorm", 1, 1, false, T::Snorm},
    {VK_FORMAT_R8G8_SNORM, "rg8_snorm", 2, 2, false, T::Snorm},
    {VK_FORMAT_R8G8B8A8_SNORM, "rgba8_snorm", 4, 4, false, T::Snorm},
    {VK_FORMAT_R8_UINT, "r8ui", 1, 1, false, T::Uint},
    {VK_FORMAT_R8G8_UINT, "rg8ui", 2, 2, false, T::Uint},
    {VK_FORMAT_R8G8B8A8_UINT, "rgba8ui", 4, 4, false, T::Uint},
    {VK_FORMAT_R8_SINT, "r8i", 1, 1, false, T::Sint},
    {VK_FORMAT_R8G8_SINT, "rg8i", 2, 2, false, T::Sint},
    {VK_FORMAT_R8G8B8A8_SINT, "rgba8i", 4, 4, false, T::Sint},
    {VK_FORMAT_R8_SRGB, "r8_srgb", 1, 1, false, T::Srgb},
    {VK_FORMAT_R8G8B8A8_SRGB, "rgba8_srgb", 4, 4, false, T::Srgb},
    {VK_FORMAT_B8G8R8A8_UNORM, "bgra8", 4, 4, false, T::Unorm},
    {VK_FORMAT_B8G8R8A8_SRGB, "bgra8_srgb", 4, 4, false, T::Srgb},
    {VK_FORMAT_R16_UNORM, "r16", 2, 1, false, T::Unorm},
    {VK_FORMAT_R16G16_UNORM, "rg16", 4, 2, false, T::Unorm},
    {VK_FORMAT_R16G16B16A16_UNORM, "rgba16", 8, 4, false, T::Unorm},
    {VK_FORMAT_R16_SNORM, "r16_snorm", 2, 1, false, T::Snorm},
    {VK_FORMAT_R16G16_SNORM, "rg16_snorm", 4, 2, false, T::Snorm},
    {VK_FORMAT_R16G16B16A16_SNORM, "rgba16_snorm", 8, 4, false, T::Snorm},
    {VK_FORMAT_R16_UINT, "r16ui", 2, 1, false, T::Uint},
    {VK_FORMAT_R16G16_UINT, "rg16ui", 4, 2, false, T::Uint},
    {VK_FORMAT_R16G16B16A16_UINT, "rgba16ui", 8, 4, false, T::Uint},
    {VK_FORMAT_R16_SINT, "r16i", 2, 1, false, T::Sint},
    {VK_FORMAT_R16G16_SINT, "rg16i", 4, 2, false, T::Sint},
    {VK_FORMAT_R16G16B16A16_SINT, "rgba16i", 8, 4, false, T::Sint},
    {VK_FORMAT_R16_SFLOAT, "r16f", 2, 1, false, T::Float},
    {VK_FORMAT_R16G16_SFLOAT, "rg16f", 4, 2, false, T::Float},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f", 8, 4, false, T::Float},
    {VK_FORMAT_R32_UINT, "r32ui", 4, 1, false, T::Uint},
    {VK_FORMAT_R32G32_UINT, "rg32ui", 8, 2, false, T::Uint},
    {VK_FORMAT_R32G32B32A32_UINT, "rgba32ui", 16, 4, false, T::Uint},
    {VK_FORMAT_R32_SINT, "r32i", 4, 1, false, T::Sint},
    {VK_FORMAT_R32G32_SINT, "rg32i", 8, 2, false, T::Sint},
    {VK_FORMAT_R32G32B32A32_SINT, "rgba32i", 16, 4, false, T::Sint},
    {VK_FORMAT_R32_SFLOAT, "r32f", 4, 1, false, T::Float},
    {VK_FORMAT_R32G32_SFLOAT, "rg32f", 8, 2, false, T::Float},
    {VK_FORMAT_R32G32B32_SFLOAT, "rgb32f", 12, 3, false, T::Float},  // vertex and texel data only
    {VK_FORMAT_R32G32B32A32_SFLOAT, "rgba32f", 16, 4, false, T::Float},
    {VK_FORMAT_R64_UINT, "r64ui", 8, 1, false, T::Uint},
    {VK_FORMAT_R64_SINT, "r64i", 8, 1, false, T::Sint},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "r11f_g11f_b10f", 4, 3, false, T::Float},
    {VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, "rgb9_e5", 4, 3, false, T::Float},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "rgb10_a2", 4, 4, false, T::Unorm},
    {VK_FORMAT_A2B10G10R10_UINT_PACK32, "rgb10_a2ui", 4, 4, false, T::Uint},
    {VK_FORMAT_D16_UNORM, "d16", 2, 1, true, T::Unorm},
    {VK_FORMAT_D32_SFLOAT, "d32f", 4, 1, true, T::Float},
};

}  // namespace

std::span<const FormatInfo> formats() { return kFormats; }

const FormatInfo* findFormat(VkFormat format) {
  for (const FormatInfo& info : kFormats) {
    if (info.format == format) return &info;
  }
  return nullptr;
}

const FormatInfo& formatInfo(VkFormat format) {
  if (const FormatInfo* info = findFormat(format)) return *info;
  throw Error(ExitCode::Internal,
              "VkFormat " + std::to_string(int(format)) + " is not one of fovea's formats");
}

VkFormat formatFromName(std::string_view name) {
  for (const FormatInfo& info : kFormats) {
    if (info.name == name) return info.format;
  }
  return VK_FORMAT_UNDEFINED;
}

bool holdsLight(VkFormat format) {
  const FormatInfo& info = formatInfo(format);
  const uint32_t channelBytes = info.bytesPerTexel / info.channels;
  return info.type == T::Float && !info.depth && info.bytesPerTexel % info.channels == 0 &&
         (channelBytes == 2 || channelBytes == 4);
}

namespace {

template <class T, class Convert>
std::vector<float> convertAll(std::span<const std::byte> texels, Convert convert) {
  std::vector<float> values(texels.size() / sizeof(T));
  for (size_t i = 0; i < values.size(); ++i) {
    T stored;
    std::memcpy(&stored, texels.data() + i * sizeof(T), sizeof(T));
    values[i] = convert(stored);
  }
  return values;
}

}  // namespace

std::vector<float> texelsToFloats(VkFormat format, std::span<const std::byte> texels) {
  const FormatInfo& info = formatInfo(format);
  const bool unorm = info.type == T::Unorm || info.type == T::Srgb;
  // Packed formats have channels of different widths, and bgra8 would need its channels swapped.
  const bool plain = info.name.find('_') == std::string_view::npos || info.name.ends_with("_snorm") ||
                     info.name.ends_with("_srgb");
  if (plain && !info.name.starts_with("bgra")) {
    switch (info.bytesPerTexel / info.channels) {
      case 4:
        if (info.type == T::Float) return convertAll<float>(texels, [](float v) { return v; });
        break;
      case 2:
        if (info.type == T::Float)
          return convertAll<uint16_t>(texels, [](uint16_t v) { return glm::unpackHalf1x16(v); });
        if (unorm) return convertAll<uint16_t>(texels, [](uint16_t v) { return float(v) / 65535.0f; });
        if (info.type == T::Snorm)
          return convertAll<int16_t>(texels, [](int16_t v) { return std::max(float(v) / 32767.0f, -1.0f); });
        break;
      case 1:
        if (unorm) return convertAll<uint8_t>(texels, [](uint8_t v) { return float(v) / 255.0f; });
        if (info.type == T::Snorm)
          return convertAll<int8_t>(texels, [](int8_t v) { return std::max(float(v) / 127.0f, -1.0f); });
        break;
    }
  }
  throw Error(ExitCode::Internal,
              "texels of format " + std::string(info.name) + " have no conversion to floats");
}

std::vector<std::byte> floatsToTexels(VkFormat format, std::span<const float> values) {
  const FormatInfo& info = formatInfo(format);
  const bool half = info.bytesPerTexel / info.channels == 2;
  std::vector<std::byte> texels(values.size() * (half ? 2 : 4));
  if (!half) {
    std::memcpy(texels.data(), values.data(), texels.size());
    return texels;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    const uint16_t stored = glm::packHalf1x16(values[i]);
    std::memcpy(&texels[2 * i], &stored, sizeof stored);
  }
  return texels;
}

VkFormat floatFormat(uint32_t channels) {
  constexpr VkFormat kFormats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                                   VK_FORMAT_R32G32B32A32_SFLOAT};
  return kFormats[channels - 1];
}

}  // namespace fovea::gpu
