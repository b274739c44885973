#include "framework/gpu/format.h"

#include <gtest/gtest.h>

#include <set>
#include <span>
#include <string>
#include <vector>

#include "fovea/error.h"

namespace fovea::gpu {
namespace {

TEST(Format, EveryNameRoundTrips) {
  std::set<std::string_view> names;
  std::set<VkFormat> seen;
  for (const FormatInfo& info : formats()) {
    EXPECT_EQ(formatFromName(info.name), info.format) << info.name;
    EXPECT_EQ(&formatInfo(info.format), &info) << info.name;
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " twice";
    EXPECT_TRUE(seen.insert(info.format).second) << info.name << " repeats a format";
  }
  EXPECT_GE(names.size(), 40u);
}

// The number in the name is the number of bits of one channel, so this test reveals a slip in the table.
TEST(Format, SizesFollowFromTheNames) {
  for (const FormatInfo& info : formats()) {
    const std::string name(info.name);
    if (name.find("10") != name.npos || name.find("11") != name.npos || name.find("9_e5") != name.npos) {
      EXPECT_EQ(info.bytesPerTexel, 4u) << name;
      continue;
    }
    const size_t digits = name.find_first_of("0123456789");
    const std::string channels = name.substr(0, digits);
    EXPECT_EQ(info.channels, channels == "d" ? 1u : channels.size()) << name;
    EXPECT_EQ(info.bytesPerTexel * 8, info.channels * std::stoul(name.substr(digits))) << name;
  }
}

TEST(Format, TypesFollowFromTheNames) {
  using Type = FormatInfo::Type;
  for (const FormatInfo& info : formats()) {
    const std::string_view name = info.name;
    const Type expected = name.ends_with("_srgb")                    ? Type::Srgb
                          : name.ends_with("_snorm")                 ? Type::Snorm
                          : name.ends_with("ui")                     ? Type::Uint
                          : name.ends_with("i")                      ? Type::Sint
                          : name.ends_with("f") || name == "rgb9_e5" ? Type::Float
                                                                     : Type::Unorm;
    EXPECT_EQ(int(info.type), int(expected)) << name;
    EXPECT_EQ(info.depth, name.starts_with("d")) << name;
  }
}

TEST(Format, UnknownNamesAndFormats) {
  EXPECT_EQ(formatFromName("rgba17f"), VK_FORMAT_UNDEFINED);
  EXPECT_EQ(formatFromName(""), VK_FORMAT_UNDEFINED);
  EXPECT_EQ(formatFromName("RGBA8"), VK_FORMAT_UNDEFINED);
  EXPECT_THROW(formatInfo(VK_FORMAT_ASTC_4x4_UNORM_BLOCK), Error);
}

template <class Stored>
std::vector<float> decode(VkFormat format, const std::vector<Stored>& texels) {
  return texelsToFloats(format, std::as_bytes(std::span(texels)));
}

TEST(Format, TexelsToFloats) {
  using Floats = std::vector<float>;
  EXPECT_EQ(decode<float>(VK_FORMAT_R32G32_SFLOAT, {1.5f, -2e30f}), (Floats{1.5f, -2e30f}));
  EXPECT_EQ(decode<float>(VK_FORMAT_D32_SFLOAT, {0.25f}), (Floats{0.25f}));
  EXPECT_EQ(decode<uint16_t>(VK_FORMAT_R16G16_SFLOAT, {0x3c00, 0xc100}), (Floats{1, -2.5f}));
  EXPECT_EQ(decode<uint8_t>(VK_FORMAT_R8G8B8A8_UNORM, {0, 51, 102, 255}), (Floats{0, 0.2f, 0.4f, 1}));
  EXPECT_EQ(decode<uint8_t>(VK_FORMAT_R8G8B8A8_SRGB, {0, 51, 102, 255}), (Floats{0, 0.2f, 0.4f, 1}));
  EXPECT_EQ(decode<uint16_t>(VK_FORMAT_R16_UNORM, {65535}), (Floats{1}));
  EXPECT_EQ(decode<int8_t>(VK_FORMAT_R8G8_SNORM, {127, -128}), (Floats{1, -1}));
  EXPECT_EQ(decode<int16_t>(VK_FORMAT_R16_SNORM, {-32767}), (Floats{-1}));
  for (VkFormat format : {VK_FORMAT_R32_UINT, VK_FORMAT_R8_SINT, VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                          VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_B8G8R8A8_UNORM})
    EXPECT_THROW(decode<uint32_t>(format, {1}), Error) << formatInfo(format).name;
}

}  // namespace
}  // namespace fovea::gpu
