// Tests the numbers and pictures that the viewer derives from resources that were read back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "fovea/error.h"
#include "fovea/image.h"
#include "samples/fovea/view/picture/compare.h"
#include "samples/fovea/view/picture/display.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

template <class T>
graph::OutputData image(VkFormat format, uint32_t width, uint32_t height, const std::vector<T>& texels) {
  graph::OutputData data;
  data.desc.format = format;
  data.desc.width = width;
  data.desc.height = height;
  data.bytes.resize(texels.size() * sizeof(T));
  std::memcpy(data.bytes.data(), texels.data(), data.bytes.size());
  return data;
}

uint32_t bits(float value) {
  uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  return word;
}

TEST(ViewTexels, FloatsKeepEveryBit) {
  const std::vector<float> texels = {0.1f, -0.0f, kNan, kInf, 1e-42f, 3, 4, 5};
  const auto data = image(VK_FORMAT_R32G32B32A32_SFLOAT, 2, 1, texels);
  const std::vector<uint32_t> all = words(data, {0, 0, 2, 1});
  ASSERT_EQ(all.size(), 8u);
  for (size_t i = 0; i < 8; ++i) EXPECT_EQ(all[i], bits(texels[i])) << i;
  EXPECT_EQ(words(data, {1, 0, 1, 1}), (std::vector<uint32_t>{bits(1e-42f), bits(3), bits(4), bits(5)}));
}

TEST(ViewTexels, OtherFormatsBecomeNumbers) {
  const auto half =
      image<uint16_t>(VK_FORMAT_R16G16_SFLOAT, 1, 1, {glm::packHalf1x16(0.5f), glm::packHalf1x16(-2)});
  EXPECT_EQ(numbers(half), (std::vector<float>{0.5f, -2}));
  const auto unorm = image<uint8_t>(VK_FORMAT_R8G8B8A8_UNORM, 1, 1, {0, 51, 255, 102});
  EXPECT_EQ(numbers(unorm), (std::vector<float>{0, 0.2f, 1, 0.4f}));
  EXPECT_TRUE(layoutOf(unorm.desc).encoded);
  const auto bgra = image<uint8_t>(VK_FORMAT_B8G8R8A8_UNORM, 1, 1, {0, 51, 255, 102});
  EXPECT_EQ(numbers(bgra), (std::vector<float>{1, 0.2f, 0, 0.4f}));
  const auto snorm = image<int8_t>(VK_FORMAT_R8G8_SNORM, 1, 1, {-128, 127});
  EXPECT_EQ(numbers(snorm), (std::vector<float>{-1, 1}));
  const auto whole = image<uint32_t>(VK_FORMAT_R32_UINT, 2, 1, {7, 4000000000u});
  EXPECT_EQ(layoutOf(whole.desc).type, Layout::Type::Unsigned);
  EXPECT_EQ(words(whole, {1, 0, 1, 1}), (std::vector<uint32_t>{4000000000u}));
  EXPECT_EQ(numbers(image<int16_t>(VK_FORMAT_R16_SINT, 1, 1, {-5})), (std::vector<float>{-5}));
  const auto packed =
      image<uint32_t>(VK_FORMAT_B10G11R11_UFLOAT_PACK32, 1, 1, {glm::packF2x11_1x10(glm::vec3(0.5f, 2, 8))});
  EXPECT_EQ(numbers(packed), (std::vector<float>{0.5f, 2, 8}));
  const auto shared = image<uint32_t>(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, 1, 1, {16u << 27 | 256u << 9 | 128u});
  EXPECT_EQ(numbers(shared), (std::vector<float>{0.5f, 1, 0}));
}

TEST(ViewTexels, BuffersAreRowsOfWords) {
  graph::OutputData data;
  data.desc.kind = graph::ResourceKind::Buffer;
  data.desc.stride = 8;
  data.desc.count = 3;
  const std::vector<float> values = {1, 2, 3, 4, 5, 6};
  data.bytes.resize(24);
  std::memcpy(data.bytes.data(), values.data(), 24);
  EXPECT_EQ(layoutOf(data.desc).width, 3u);
  EXPECT_EQ(layoutOf(data.desc).channels, 2u);
  EXPECT_EQ(words(data, {2, 0, 1, 1}), (std::vector<uint32_t>{bits(5), bits(6)}));
}

TEST(ViewTexels, StatisticsCountWhatIsNoNumber) {
  const auto data = image<float>(VK_FORMAT_R32_SFLOAT, 3, 2, {1, kNan, 3, kInf, -kInf, 2});
  const ChannelStatistics s = statistics(data, wholeOf(layoutOf(data.desc))).at(0);
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 3);
  EXPECT_DOUBLE_EQ(s.mean, 2);
  EXPECT_EQ(s.nan, 1u);
  EXPECT_EQ(s.infinite, 2u);
  EXPECT_EQ(s.histogram.front(), 1u);
  EXPECT_EQ(s.histogram.back(), 1u);
  const auto constant = image<float>(VK_FORMAT_R32_SFLOAT, 2, 1, {5, 5});
  EXPECT_EQ(statistics(constant, {0, 0, 2, 1}).at(0).histogram[0], 2u);
}

using Rgb = std::array<int, 3>;
Rgb pixel(const Pixels& p, size_t i) { return {p.rgb[3 * i], p.rgb[3 * i + 1], p.rgb[3 * i + 2]}; }

TEST(ViewDisplay, ShowsRadianceAsTheDisplayWould) {
  const auto data = image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, {0.5f, 0.25f, 4, 1});
  const auto level = [](float v) { return int(std::lround(255 * image::srgbEncode(v))); };
  EXPECT_EQ(pixel(draw(data, {}), 0), (Rgb{level(0.5f), level(0.25f), 255}));
  EXPECT_EQ(pixel(draw(data, parseDisplay("exposure=-1")), 0), (Rgb{level(0.25f), level(0.125f), 255}));
  EXPECT_EQ(pixel(draw(data, parseDisplay("curve=linear&high=2")), 0), (Rgb{64, 32, 255}));
  EXPECT_EQ(pixel(draw(data, parseDisplay("channel=green")), 0), (Rgb{64, 64, 64}));
  EXPECT_EQ(pixel(draw(data, parseDisplay("channel=alpha")), 0), (Rgb{255, 255, 255}));
}

TEST(ViewDisplay, LeavesDisplayValuesAlone) {
  const auto data = image<uint8_t>(VK_FORMAT_R8G8B8A8_UNORM, 2, 1, {1, 2, 3, 255, 250, 128, 0, 255});
  EXPECT_EQ(pixel(draw(data, {}), 0), (Rgb{1, 2, 3}));
  EXPECT_EQ(pixel(draw(data, {}), 1), (Rgb{250, 128, 0}));
}

TEST(ViewDisplay, MarksWhatIsNoNumber) {
  const auto data =
      image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 3, 1, {kNan, 0, 0, 1, 0, kInf, 0, 1, 0, 0, -kInf, 1});
  const Pixels marked = draw(data, {});
  EXPECT_EQ(pixel(marked, 0), (Rgb{255, 0, 255}));
  EXPECT_EQ(pixel(marked, 1), (Rgb{0, 255, 255}));
  EXPECT_EQ(pixel(marked, 2), (Rgb{255, 140, 0}));
  EXPECT_EQ(pixel(draw(data, parseDisplay("marks=0")), 1), (Rgb{0, 255, 0}));
}

TEST(ViewDisplay, FitsTheRangeOfDataButNotOfColours) {
  const auto depth = image<float>(VK_FORMAT_R32_SFLOAT, 3, 1, {0.99f, kNan, 0.999f});
  const Pixels shown = draw(depth, parseDisplay("fit=1"));
  EXPECT_EQ(pixel(shown, 0), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(shown, 1), (Rgb{255, 0, 255}));
  EXPECT_EQ(pixel(shown, 2), (Rgb{255, 255, 255}));
  const auto color = image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, {0.5f, 0.5f, 0.5f, 1});
  EXPECT_EQ(draw(color, parseDisplay("fit=1")).rgb, draw(color, {}).rgb);
}

TEST(ViewDisplay, FalseColoursGetLighter) {
  std::vector<float> ramp(256);
  for (size_t i = 0; i < ramp.size(); ++i) ramp[i] = float(i);
  const Pixels p = draw(image(VK_FORMAT_R32_SFLOAT, 256, 1, ramp), parseDisplay("map=helix&high=255"));
  const auto lightness = [&](size_t i) {
    const Rgb c = pixel(p, i);
    return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2];
  };
  EXPECT_EQ(pixel(p, 0), (Rgb{0, 0, 0}));
  EXPECT_EQ(pixel(p, 255), (Rgb{255, 255, 255}));
  for (size_t i = 0; i + 8 < 256; i += 8) EXPECT_LT(lightness(i), lightness(i + 8)) << i;
}

TEST(ViewDisplay, NumbersBelowZeroAreBlueAndThoseAboveRed) {
  const auto data = image<float>(VK_FORMAT_R32_SFLOAT, 4, 1, {-1, 0, 0.5f, 2});
  for (const char* how : {"fit=1", "fit=1&map=signed", "map=signed&low=-1&high=2"}) {
    const Pixels p = draw(data, parseDisplay(how));
    EXPECT_EQ(p.map, Display::Map::Signed) << how;
    EXPECT_EQ(p.low, -2) << how;
    EXPECT_EQ(p.high, 2) << how;
    const Rgb below = pixel(p, 0), zero = pixel(p, 1), above = pixel(p, 2), most = pixel(p, 3);
    EXPECT_GT(below[2], below[0]) << how;
    EXPECT_EQ(*std::ranges::min_element(zero), *std::ranges::max_element(zero)) << how;
    EXPECT_GT(zero[0], 240) << how;
    EXPECT_GT(above[0], above[2]) << how;
    EXPECT_GT(above[2], most[2]) << how;
  }
  EXPECT_EQ(draw(data, parseDisplay("fit=1&map=plain")).map, Display::Map::Plain);
  // Colours stay colours, and numbers without a sign are grey.
  const auto color = image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, {-0.5f, 0.5f, 0.5f, 1});
  EXPECT_EQ(draw(color, parseDisplay("fit=1")).map, Display::Map::Plain);
  EXPECT_EQ(draw(color, parseDisplay("fit=1&channel=red")).map, Display::Map::Signed);
  const auto positive = image<float>(VK_FORMAT_R32_SFLOAT, 2, 1, {0, 2});
  EXPECT_EQ(draw(positive, parseDisplay("fit=1")).map, Display::Map::Plain);
}

TEST(ViewDisplay, PreviewsAreSmallerAndJpegsAreJpegs) {
  const auto data = image(VK_FORMAT_R32_SFLOAT, 64, 32, std::vector<float>(64 * 32, 0.5f));
  const Pixels small = draw(data, parseDisplay("width=16"));
  EXPECT_EQ(small.width, 16u);
  EXPECT_EQ(small.height, 8u);
  EXPECT_EQ(pixel(small, 5), (Rgb{128, 128, 128}));
  const std::string bytes = jpeg(small, 90);
  const image::Image8 back =
      image::decode8(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "preview.jpg");
  EXPECT_EQ(back.width, 16u);
  EXPECT_EQ(back.height, 8u);
}

TEST(ViewCompare, FramesAddUpToTheirMean) {
  FrameMean mean;
  const auto frame = [](float v) {
    return image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, {v, 2 * v, 0, 1});
  };
  EXPECT_TRUE(FrameMean::canAdd(frame(1).desc));
  EXPECT_FALSE(FrameMean::canAdd(image<uint8_t>(VK_FORMAT_R8G8B8A8_UNORM, 1, 1, {1, 2, 3, 4}).desc));
  EXPECT_EQ(numbers(mean.add(frame(1))), (std::vector<float>{1, 2, 0, 1}));
  EXPECT_EQ(numbers(mean.add(frame(4))), (std::vector<float>{2.5f, 5, 0, 1}));
  EXPECT_EQ(mean.frames(), 2u);
  mean.reset();
  EXPECT_EQ(numbers(mean.add(frame(8))), (std::vector<float>{8, 16, 0, 1}));
}

TEST(ViewCompare, DifferencesAreAbsolute) {
  const auto a = image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, {1, 5, 0.5f, 1}),
             b = image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, {3, 2, 0.5f, 0});
  EXPECT_EQ(numbers(difference(a, b)), (std::vector<float>{2, 3, 0, 1}));
  EXPECT_THROW(difference(a, image<float>(VK_FORMAT_R32G32B32A32_SFLOAT, 2, 1, std::vector<float>(8))),
               Error);
  EXPECT_THROW(difference(a, image<float>(VK_FORMAT_R32_SFLOAT, 1, 1, {1})), Error);
}

TEST(ViewCompare, MeasuresTheFoveaAndWhatIsOutside) {
  std::vector<float> white(4 * 16, 1), black = white;
  for (size_t i = 0; i < 8; ++i) std::fill_n(black.begin() + ptrdiff_t(4 * i), 3, 0.0f);  // the upper half
  const auto m = measure(image(VK_FORMAT_R32G32B32A32_SFLOAT, 4, 4, black),
                         image(VK_FORMAT_R32G32B32A32_SFLOAT, 4, 4, white), 1, {0.5f, 1}, 0.3f);
  EXPECT_NEAR(m.whole.mse, 0.5, 1e-6);
  EXPECT_EQ(m.fovea.mse, 0);
  EXPECT_GT(m.periphery.mse, 0.5);
}

}  // namespace
}  // namespace fovea::view
