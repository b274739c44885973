// Texel formats by the short names used in graph files, help texts and shaders ("rgba16f").
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace fovea::gpu {

struct FormatInfo {
  VkFormat format;
  std::string_view name;  // "rgba16f", as in a GLSL layout qualifier where GLSL has one
  uint32_t bytesPerTexel;
  uint32_t channels;
  bool depth;
  enum class Type : uint8_t { Float, Unorm, Snorm, Uint, Sint, Srgb } type;

  bool integer() const { return type == Type::Uint || type == Type::Sint; }
};

std::span<const FormatInfo> formats();          // all formats that fovea knows
const FormatInfo* findFormat(VkFormat format);  // nullptr for formats that fovea does not know
// Throws Error(Internal) for formats that fovea does not know.
const FormatInfo& formatInfo(VkFormat format);
// VK_FORMAT_UNDEFINED if there is no such name.
VkFormat formatFromName(std::string_view name);

// The format of texels with so many channels, 1 to 4, of 32-bit floats.
VkFormat floatFormat(uint32_t channels);

// Whether texels of the format can hold light: 16- or 32-bit floats, one for each channel, and no depth.
bool holdsLight(VkFormat format);

// Converts tightly packed texels to floats with interleaved channels: unorm and sRGB to [0, 1] (without removing the
// sRGB curve), snorm to [-1, 1]. Throws Error(Internal) for integer and packed formats.
std::vector<float> texelsToFloats(VkFormat format, std::span<const std::byte> texels);

// The inverse for formats that hold light (holdsLight()).
std::vector<std::byte> floatsToTexels(VkFormat format, std::span<const float> values);

}  // namespace fovea::gpu
