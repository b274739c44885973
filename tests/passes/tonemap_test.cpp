#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <tuple>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 37, kHeight = 13;  // not whole work groups

// IEC 61966-2-1 in double precision.
double srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }
int expectedByte(double radiance, double exposure) {
  return int(std::floor(255 * srgb(std::clamp(exposure * radiance, 0.0, 1.0)) + 0.5));
}

// Values over eight decades, so that both branches of the curve and the clamp are met.
std::vector<float> ramp() {
  std::vector<float> texels;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i)
    for (uint32_t c = 0; c < 4; ++c)
      texels.push_back(std::pow(10.0f, -6.0f + 8.0f * uniformFloat(randomStream(1, 2, c, i))));
  return texels;
}

void expectImage(const PassTest& test, const std::vector<float>& radiance, double exposure) {
  const auto image = test.values<uint8_t>("image");
  ASSERT_EQ(image.size(), size_t(kWidth) * kHeight * 4);
  int offByOne = 0;
  for (size_t i = 0; i < image.size(); ++i) {
    const int want = i % 4 == 3 ? 255 : expectedByte(radiance[i], exposure);
    EXPECT_NEAR(image[i], want, 1) << "channel " << i;
    offByOne += image[i] != want;
  }
  // Only a value within the rounding error of pow() of the midpoint between two bytes may be rounded to the other byte.
  EXPECT_LE(offByOne, int(image.size() / 500));
}

TEST(Tonemap, EqualsTheTransferFunction) {
  const auto radiance = ramp();
  for (const double exposure : {1.0, 0.25, 7.5}) {
    PassTest test("tonemap");
    test.param("exposure", exposure).viewSize(kWidth, kHeight);
    test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, radiance);
    test.run();
    expectImage(test, radiance, exposure);
    EXPECT_EQ(test.counter("non_finite"), 0);
  }
}

TEST(Tonemap, TakesTheScenesExposure) {
  const auto radiance = ramp();
  scene::Scene scene;
  scene.exposure = 3;
  scene.materials.emplace_back();
  PassTest test("tonemap");
  test.viewSize(kWidth, kHeight).scene(scene);
  test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, radiance);
  test.run();
  expectImage(test, radiance, 3);
}

TEST(Tonemap, AnAdaptedExposureReplacesTheScenesButNotAGivenOne) {
  const auto radiance = ramp();
  for (const double given : {0.0, 2.0}) {
    PassTest test("tonemap");
    test.param("exposure", given).viewSize(kWidth, kHeight);
    test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, radiance);
    test.image("adapted", VK_FORMAT_R32_SFLOAT, 1, 1, 1, std::vector<float>{5});
    test.run();
    expectImage(test, radiance, given > 0 ? given : 5);
  }
}

TEST(Tonemap, NotANumberIsBlackAndCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<float> radiance = {nan,  0.5f, 0.5f, 1,   inf, 0.5f, -inf, 1,
                                       0.5f, 0.5f, 0.5f, nan, -1,  0.5f, 0,    1};
  PassTest test("tonemap");
  test.param("exposure", 1.0).viewSize(4, 1);
  test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, 4, 1, 1, radiance);
  test.run();
  const int half = expectedByte(0.5, 1);
  const std::vector<int> want = {0, 0, 0, 255, 255, half, 0, 255, half, half, half, 255, 0, half, 0, 255};
  const auto image = test.values<uint8_t>("image");
  EXPECT_EQ(std::vector<int>(image.begin(), image.end()), want);
  EXPECT_EQ(test.counter("non_finite"), 2);  // alpha does not matter
}

TEST(Tonemap, ReinhardKeepsHueBelowOne) {
  const std::vector<float> radiance = {4, 2, 1, 1};
  PassTest test("tonemap");
  test.param("exposure", 1.0).param("operator", "reinhard").viewSize(1, 1);
  test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, 1, radiance);
  test.run();
  const double scale = 1 / (1 + 0.2126 * 4 + 0.7152 * 2 + 0.0722);
  const auto image = test.values<uint8_t>("image");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image[c], expectedByte(radiance[c], scale), 1);
}

// The published formulas of AgX, written out in double precision; the result is linear, from 0 to 1.
glm::dvec3 agx(const glm::dvec3& light, double contrast, double saturation) {
  const double in[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                           {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                           {0.0423756549057051, 0.0784336, 0.879142973793104}};
  const double out[3][3] = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                            {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                            {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
  const double coefficients[] = {-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5};
  glm::dvec3 code(0), display;
  for (int c = 0; c < 3; ++c) {
    const double narrow = in[c][0] * light.r + in[c][1] * light.g + in[c][2] * light.b;
    const double stops = std::clamp(std::log2(std::max(narrow, 1e-10)), -12.47393, 4.026069);
    for (int power = 0; power < 7; ++power)
      code[c] += coefficients[power] * std::pow((stops + 12.47393) / (4.026069 + 12.47393), power);
  }
  for (int c = 0; c < 3; ++c) code[c] = std::pow(std::max(code[c], 0.0), contrast);
  const double luminance = 0.2126 * code.r + 0.7152 * code.g + 0.0722 * code.b;
  for (int c = 0; c < 3; ++c) code[c] = luminance + saturation * (code[c] - luminance);
  for (int c = 0; c < 3; ++c) {
    const double wide = out[c][0] * code.r + out[c][1] * code.g + out[c][2] * code.b;
    display[c] = std::pow(std::clamp(wide, 0.0, 1.0), 2.2);
  }
  return display;
}

TEST(Tonemap, AgxEqualsThePublishedFormulas) {
  const auto radiance = ramp();
  for (const auto& [exposure, contrast, saturation] :
       {std::tuple(1.0, 1.0, 1.0), std::tuple(7.5, 1.35, 1.4), std::tuple(7.5, 0.8, 0.0)}) {
    PassTest test("tonemap");
    test.param("exposure", exposure).param("operator", "agx").viewSize(kWidth, kHeight);
    test.param("contrast", contrast).param("saturation", saturation);
    test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, radiance);
    test.run();
    const auto image = test.values<uint8_t>("image");
    for (size_t i = 0; i < image.size(); i += 4) {
      const glm::dvec3 want =
          agx(exposure * glm::dvec3(radiance[i], radiance[i + 1], radiance[i + 2]), contrast, saturation);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image[i + size_t(c)], expectedByte(want[c], 1), 1) << i << " " << c;
      EXPECT_EQ(image[i + 3], 255);
    }
  }
}

// Middle grey lies in the middle of the codes, and brightness beyond 1 still differs. What is much brighter than the
// display turns towards white, also where it is a pure colour. Broken values are treated as with the other curves.
TEST(Tonemap, AgxKeepsMiddleGreyAndWhitensHighlights) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<float> radiance = {0.18f, 0.18f, 0.18f, 1, 1, 1, 1, 1, 4,   4, 4, 1, 0.5f, 0,   0,   1,
                                       60,    0,     0,     1, 0, 0, 0, 1, nan, 0, 0, 1, inf,  inf, inf, 1};
  PassTest test("tonemap");
  test.param("exposure", 1.0).param("operator", "agx").viewSize(8, 1);
  test.image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, 8, 1, 1, radiance);
  test.run();
  const auto image = test.values<uint8_t>("image");
  const auto red = [&](size_t i) { return int(image[4 * i]); };
  const auto green = [&](size_t i) { return int(image[4 * i + 1]); };
  EXPECT_NEAR(red(0), 127.5, 1);
  EXPECT_GT(red(1), red(0) + 50);
  EXPECT_GT(red(2), red(1) + 15);
  EXPECT_LT(red(2), 255);
  EXPECT_LT(green(3), 0.6 * red(3));
  EXPECT_GT(green(4), 0.7 * red(4));
  EXPECT_EQ(red(5), 0);
  EXPECT_EQ(red(6), 0);
  EXPECT_GE(red(7), 250);
  EXPECT_EQ(test.counter("non_finite"), 2);
}

}  // namespace
}  // namespace fovea::test
