#include "tests/references/fovea.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fovea::scene {
namespace {

// Part of each pixel that the disc covers, estimated with 64 x 64 points in it.
std::vector<double> coverage(const Fovea& fovea, glm::ivec2 size) {
  std::vector<double> part;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      int inside = 0;
      for (int k = 0; k < 64 * 64; ++k) {
        const double dx = x + (k % 64 + 0.5) / 64 - double(fovea.centre.x),
                     dy = y + (k / 64 + 0.5) / 64 - double(fovea.centre.y);
        inside += dx * dx + dy * dy <= double(fovea.radius) * double(fovea.radius);
      }
      part.push_back(inside / 4096.0);
    }
  return part;
}

// Chi-square of the drawn pixels against `part`, in standard deviations from its mean. Pixels that expect less than 8
// draws are merged.
double deviation(uint32_t region, const Fovea& fovea, glm::ivec2 size, const std::vector<double>& part,
                 uint32_t draws) {
  std::vector<uint32_t> count(part.size());
  for (uint32_t i = 0; i < draws; ++i) {
    const glm::ivec2 p = regionSample(region, fovea, size, randomStream(7, 0, 1, i));
    EXPECT_TRUE(p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y);
    ++count[size_t(p.y * size.x + p.x)];
  }
  double sum = 0, chi2 = 0, restExpected = 0, restCount = 0;
  int bins = 0;
  for (const double p : part) sum += p;
  const auto add = [&](double expected, double n) {
    chi2 += (n - expected) * (n - expected) / expected;
    ++bins;
  };
  for (size_t i = 0; i < part.size(); ++i) {
    if (part[i] == 0) {
      EXPECT_EQ(count[i], 0u) << "pixel " << i << " lies outside";
    }
    const double expected = draws * part[i] / sum;
    if (expected >= 8) {
      add(expected, count[i]);
    } else {
      restExpected += expected;
      restCount += count[i];
    }
  }
  if (restExpected >= 8) add(restExpected, restCount);
  return bins < 2 ? 0 : (chi2 - (bins - 1)) / std::sqrt(2.0 * (bins - 1));
}

constexpr glm::ivec2 kSize{32, 20};
const std::vector<double> kEverywhere(size_t(32 * 20), 1.0);

TEST(Fovea, WeightIsOneInsideAndFallsWithTheDistanceOutside) {
  const Fovea f = makeFovea({0.25f, 0.5f}, {400, 200}, 0.1f);
  EXPECT_EQ(f.centre, glm::vec2(100, 100));
  EXPECT_FLOAT_EQ(f.radius, 40);
  EXPECT_EQ(foveaWeight(f, {100, 100}), 1);
  EXPECT_EQ(foveaWeight(f, {139.9f, 100}), 1);
  EXPECT_NEAR(foveaWeight(f, {140.1f, 100}), 1, 0.003);
  EXPECT_FLOAT_EQ(foveaWeight(f, {100, 180}), 0.5f);
  EXPECT_FLOAT_EQ(foveaWeight(f, {300, 100}), 0.2f);
}

TEST(RegionSample, WholeImageIsUniform) {
  const Fovea f = makeFovea({0.1f, 0.9f}, kSize, 0.05f);
  EXPECT_LT(std::abs(deviation(kRegionImage, f, kSize, kEverywhere, 40000)), 5);
}

TEST(RegionSample, DiscIsUniform) {
  for (const glm::vec2 gaze : {glm::vec2(0.5f), glm::vec2(0.43f, 0.55f), glm::vec2(0), glm::vec2(1, 0.4f),
                               glm::vec2(0.7f, 1.1f), glm::vec2(-0.12f, -0.2f)}) {
    const Fovea f = makeFovea(gaze, kSize, 0.25f);
    EXPECT_LT(std::abs(deviation(kRegionFovea, f, kSize, coverage(f, kSize), 40000)), 5)
        << gaze.x << ", " << gaze.y;
  }
}

TEST(RegionSample, FoveaOutsideTheImageMeansTheImage) {
  for (const glm::vec2 gaze : {glm::vec2(2, 0.5f), glm::vec2(-3, -3), glm::vec2(0.5f, 30)}) {
    const Fovea f = makeFovea(gaze, kSize, 0.25f);
    EXPECT_LT(std::abs(deviation(kRegionFovea, f, kSize, kEverywhere, 40000)), 5);
  }
}

TEST(RegionSample, FoveaThatCoversAllMeansTheImage) {
  const Fovea f = makeFovea({0.4f, 0.6f}, kSize, 4);
  EXPECT_LT(std::abs(deviation(kRegionFovea, f, kSize, kEverywhere, 40000)), 5);
}

TEST(RegionSample, TinyFoveaIsOnePixel) {
  const Fovea f = makeFovea({0.5f, 0.5f}, {33, 21}, 0.001f);
  for (uint32_t i = 0; i < 1000; ++i)
    ASSERT_EQ(regionSample(kRegionFovea, f, {33, 21}, randomStream(1, 2, 3, i)), glm::ivec2(16, 10));
}

// Only the outermost sliver of the disc reaches into the image; still, no sample comes from elsewhere.
TEST(RegionSample, SliverOfTheDisc) {
  const Fovea f{{-9.9f, 10}, 10.5f};
  for (uint32_t i = 0; i < 5000; ++i) {
    const glm::ivec2 p = regionSample(kRegionFovea, f, kSize, randomStream(1, 2, 3, i));
    ASSERT_EQ(p.x, 0);
    ASSERT_LE(std::abs(float(p.y) + 0.5f - 10), 4.1f);
  }
}

TEST(RegionSample, ImageOfOnePixel) {
  for (uint32_t i = 0; i < 100; ++i)
    for (const uint32_t region : {kRegionFovea, kRegionImage})
      ASSERT_EQ(regionSample(region, makeFovea({0.5f, 0.5f}, {1, 1}, 0.25f), {1, 1}, i), glm::ivec2(0));
}

}  // namespace
}  // namespace fovea::scene
