#include "passes/near-field/gather_cache.h"

#include <gtest/gtest.h>

#include <vector>

#include "framework/base/random.h"

namespace fovea::passes {
namespace {

constexpr glm::vec3 kStill(0);

std::vector<GatherCache::Sample> samplesOf(uint64_t cell, int count, glm::vec3 light) {
  return std::vector<GatherCache::Sample>(size_t(count), {cell, light});
}

TEST(GatherCache, MeanOfEnoughSamples) {
  GatherCache cache;
  const uint64_t cell = GatherCache::cellOf({1, 2, 3}, {0, 1, 0}, kStill, 0.25f);
  EXPECT_FALSE(cache.find(cell));
  cache.add(samplesOf(cell, 8, glm::vec3(1)));
  cache.add(samplesOf(cell, 7, glm::vec3(1)));
  EXPECT_FALSE(cache.find(cell));
  cache.add(samplesOf(cell, 5, {5, 1, 1}));
  ASSERT_TRUE(cache.find(cell));
  EXPECT_FLOAT_EQ(cache.find(cell)->r, 2);
  EXPECT_FLOAT_EQ(cache.find(cell)->g, 1);
  cache.clear();
  EXPECT_FALSE(cache.find(cell));
}

TEST(GatherCache, OldSamplesFade) {
  GatherCache cache;
  cache.add(samplesOf(5, 10000, glm::vec3(1)));
  cache.add(samplesOf(5, int(GatherCache::kMost), glm::vec3(0)));
  EXPECT_LT(cache.find(5)->r, 0.5f);
  cache.add(samplesOf(5, 3 * int(GatherCache::kMost), glm::vec3(0)));
  EXPECT_LT(cache.find(5)->r, 0.02f);
}

TEST(GatherCache, ChangedLightAgesSamples) {
  GatherCache cache;
  cache.add(samplesOf(5, 96, glm::vec3(1)));
  cache.age(0);
  cache.add(samplesOf(5, 32, glm::vec3(5)));
  EXPECT_FLOAT_EQ(cache.find(5)->r, 2);
  cache.age(1 / 128.0f);  // 128 samples are worth 64
  EXPECT_FLOAT_EQ(cache.find(5)->r, 2);
  cache.add(samplesOf(5, 64, glm::vec3(4)));
  EXPECT_FLOAT_EQ(cache.find(5)->r, 3);
  cache.age(16);
  EXPECT_FALSE(cache.find(5)) << "too few are left";
}

// Points of one cell share it, others do not; nor do the two sides of a thin wall, and cells of another width.
TEST(GatherCache, CellsOfSpace) {
  const auto cell = [&](glm::vec3 p, glm::vec3 n = {0, 1, 0}, glm::vec3 jitter = kStill, float width = 0.3f) {
    return GatherCache::cellOf(p, n, jitter, width);  // 0.3 is rounded to 0.25
  };
  EXPECT_EQ(cell({0.01f, 0.01f, 0.01f}), cell({0.24f, 0.24f, 0.24f}));
  EXPECT_NE(cell({0.01f, 0.01f, 0.01f}), cell({0.26f, 0.01f, 0.01f}));
  EXPECT_NE(cell({0.01f, 0.01f, 0.01f}), cell({-0.01f, 0.01f, 0.01f}));
  EXPECT_EQ(cell({0.26f, 0.01f, 0.01f}, {0, 1, 0}, {-0.1f, 0, 0}), cell({0.01f, 0.01f, 0.01f}));
  EXPECT_NE(cell({0, 0, 0}, {0, 1, 0}), cell({0, 0, 0}, {0, -1, 0}));
  EXPECT_EQ(cell({0, 0, 0}, {0.1f, 0.9f, 0.1f}), cell({0, 0, 0}, {-0.1f, 0.9f, 0.2f}));
  const glm::vec3 up(0, 1, 0);
  EXPECT_EQ(cell({5, 5, 5}, up, kStill, 0.27f), cell({5, 5, 5}, up, kStill, 0.3f));
  EXPECT_NE(cell({5, 5, 5}, up, kStill, 0.6f), cell({5, 5, 5}, up, kStill, 0.3f));
}

// With more cells than there are places, those with few samples give way, and no cell returns what belongs to another.
TEST(GatherCache, TheRichestCellsStay) {
  GatherCache cache;
  const auto lightOf = [](uint64_t cell) { return glm::vec3(float(cell % 1000), 1, 2); };
  std::vector<GatherCache::Sample> samples;
  for (uint64_t cell = 1; cell <= 1000; ++cell)
    for (int i = 0; i < 20; ++i)
      samples.push_back({hashPcg(uint32_t(cell)), lightOf(hashPcg(uint32_t(cell)))});
  for (uint64_t cell = 2000; cell < 2000 + 2 * GatherCache::kCells; ++cell)
    samples.push_back({hashPcg(uint32_t(cell)), lightOf(hashPcg(uint32_t(cell)))});
  cache.add(samples);
  int found = 0;
  for (uint32_t cell = 1; cell <= 1000; ++cell)
    if (const auto light = cache.find(hashPcg(cell))) {
      ++found;
      EXPECT_FLOAT_EQ(light->r, lightOf(hashPcg(cell)).r);
    }
  EXPECT_GT(found, 950);
}

}  // namespace
}  // namespace fovea::passes
