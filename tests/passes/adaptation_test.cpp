#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 96, kHeight = 64;  // each tile is 3 x 2 pixels, of which all are looked at
constexpr double kKey = 0.18, kSceneExposure = 0.5;

scene::Scene sceneWith(bool assumed) {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene.exposure = float(kSceneExposure);
  scene.assumed = assumed;
  return scene;
}

// Pixels of random colours about `level`, over four stops.
std::vector<float> picture(float level) {
  std::vector<float> texels;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i)
    for (uint32_t c = 0; c < 4; ++c)
      texels.push_back(level * std::exp2(4 * uniformFloat(randomStream(3, c, 0, i)) - 2));
  return texels;
}

// The exposure that shows the geometric mean of the luminance as the key, in double precision. Tiles count equally, and
// so do the pixels on a grid of 256 x 256 places.
double wanted(const std::vector<float>& texels) {
  double sum = 0;
  for (uint32_t y = 0; y < 256; ++y)
    for (uint32_t x = 0; x < 256; ++x) {
      const size_t at = 4 * ((2 * y + 1) * kHeight / 512 * kWidth + (2 * x + 1) * kWidth / 512);
      sum += std::log2(0.2126 * texels[at] + 0.7152 * texels[at + 1] + 0.0722 * texels[at + 2]);
    }
  return kKey / std::exp2(sum / 65536);
}

struct AdaptationTest : PassTest {
  AdaptationTest(bool assumed, const std::vector<float>& texels) : PassTest("adaptation") {
    viewSize(kWidth, kHeight).scene(sceneWith(assumed));
    image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, texels);
  }
};

TEST(Adaptation, ShowsTheMeanAsTheKeyAtOnce) {
  for (const float level : {0.05f, 0.3f, 2.0f}) {
    const std::vector<float> texels = picture(level);
    AdaptationTest test(true, texels);
    test.run();
    EXPECT_NEAR(test.floats("exposure").at(0), wanted(texels), 1e-3 * wanted(texels)) << level;
  }
}

TEST(Adaptation, FollowsAChangeInStops) {
  const std::vector<float> dark = picture(0.1f), bright = picture(0.8f);
  AdaptationTest test(true, dark);
  test.param("frames", 10.0);
  test.beforeFrame(
      [&](PassTest& t, scene::Frame& frame) { t.set("radiance", frame.index < 2 ? dark : bright); });
  double stops = std::log2(wanted(dark));
  for (uint32_t frame = 0; frame < 8; ++frame) {
    test.run(1);
    if (frame >= 2) stops += (1 - std::exp(-0.1)) * (std::log2(wanted(bright)) - stops);
    EXPECT_NEAR(std::log2(test.floats("exposure").at(0)), stops, 2e-3) << frame;
  }
}

TEST(Adaptation, StaysWithinItsRange) {
  for (const float level : {1e-3f, 500.0f}) {
    AdaptationTest test(true, picture(level));
    test.param("range", 2.0);
    test.run();
    EXPECT_FLOAT_EQ(test.floats("exposure").at(0), float(kSceneExposure) * (level < 1 ? 4.0f : 0.25f));
  }
}

TEST(Adaptation, AnExposureOfTheFileStays) {
  AdaptationTest test(false, picture(3));
  test.run(3);
  EXPECT_EQ(test.floats("exposure").at(0), float(kSceneExposure));
}

TEST(Adaptation, NotANumberAndInfinityCountAsDark) {
  std::vector<float> texels(size_t(kWidth) * kHeight * 4, std::numeric_limits<float>::quiet_NaN());
  for (size_t i = 0; i < texels.size() / 2; ++i) texels[i] = std::numeric_limits<float>::infinity();
  AdaptationTest test(true, texels);
  test.run();
  EXPECT_FLOAT_EQ(test.floats("exposure").at(0), float(kSceneExposure) * 16);
}

}  // namespace
}  // namespace fovea::test
