#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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

}  // namespace
}  // namespace fovea::test
