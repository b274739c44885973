#include "framework/base/low_discrepancy.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace fovea {
namespace {

// Among 2^m points of the first two dimensions of a group, each elementary interval of area 2^-m holds exactly one.
TEST(LowDiscrepancy, PrefixesAreNetsInTwoDimensions) {
  constexpr uint32_t m = 8;
  for (const uint32_t seed : {0u, 7u, 12345u}) {
    for (const uint32_t group : {0u, 3u}) {
      for (uint32_t split = 0; split <= m; ++split) {
        std::set<uint32_t> cells;
        for (uint32_t i = 0; i < 1u << m; ++i) {
          const uint32_t x = split == 0 ? 0 : sobolBits(i, 4 * group, seed) >> (32 - split);
          const uint32_t y = split == m ? 0 : sobolBits(i, 4 * group + 1, seed) >> (32 - (m - split));
          cells.insert(x << 16 | y);
        }
        EXPECT_EQ(cells.size(), 1u << m) << "seed " << seed << " group " << group << " split " << split;
      }
    }
  }
}

TEST(LowDiscrepancy, EveryDimensionIsStratified) {
  for (uint32_t d = 0; d < 24; ++d) {
    std::set<uint32_t> cells;
    for (uint32_t i = 0; i < 256; ++i) cells.insert(sobolBits(i, d, 5) >> 24);
    EXPECT_EQ(cells.size(), 256u) << "dimension " << d;
  }
}

TEST(LowDiscrepancy, APairIsTwoDimensions) {
  for (const uint32_t index : {0u, 5u, 70000u})
    for (const uint32_t d : {0u, 1u, 2u, 8u, 13u})
      EXPECT_EQ(sobolPair(index, d, 9), (std::array<float, 2>{sobol(index, d, 9), sobol(index, d + 1, 9)}));
}

// In any two dimensions, also of different groups, pairs must not fall on lines. There are 1024 points in 16 x 16
// cells. The points of one seed are not independent draws (single seeds reach 450), so the mean over seeds is tested.
TEST(LowDiscrepancy, PairsOfDimensionsCoverTheSquare) {
  constexpr uint32_t kSeeds = 32;
  for (uint32_t a = 0; a < 12; ++a) {
    for (uint32_t b = a + 1; b < 12; ++b) {
      double chi2 = 0;
      for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        std::vector<int> count(256);
        for (uint32_t i = 0; i < 1024; ++i)
          ++count[(sobolBits(i, a, seed) >> 28) * 16 + (sobolBits(i, b, seed) >> 28)];
        for (int c : count) chi2 += (c - 4) * (c - 4) / 4.0 / kSeeds;
      }
      EXPECT_LT(chi2, 255 + 5 * std::sqrt(2 * 255.0 / kSeeds)) << a << ", " << b;
    }
  }
}

// Owen scrambling leaves each single point uniform: over seeds, the mean of any point is 1/2 and its variance 1/12.
TEST(LowDiscrepancy, SeedsMakeASinglePointUniform) {
  constexpr int kSeeds = 20000;
  for (const uint32_t index : {0u, 1u, 1000u}) {
    for (const uint32_t dimension : {0u, 1u, 3u, 6u}) {
      double sum = 0, squares = 0;
      for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        const double x = sobol(index, dimension, seed);
        sum += x;
        squares += x * x;
      }
      const double mean = sum / kSeeds;
      EXPECT_NEAR(mean, 0.5, 4 * std::sqrt(1.0 / 12 / kSeeds));
      EXPECT_NEAR(squares / kSeeds - mean * mean, 1.0 / 12, 0.002);
    }
  }
}

// The purpose of the points: 1024 of them integrate a smooth function far better than random numbers (whose error is
// about 1 / sqrt(12 n) = 0.009).
TEST(LowDiscrepancy, IntegratesBetterThanRandomNumbers) {
  double worst = 0;
  for (uint32_t seed = 0; seed < 20; ++seed) {
    double sum = 0;
    for (uint32_t i = 0; i < 1024; ++i) sum += sobol(i, 4, seed) * sobol(i, 5, seed) * 4;
    worst = std::max(worst, std::abs(sum / 1024 - 1));
  }
  EXPECT_LT(worst, 0.002);
}

}  // namespace
}  // namespace fovea
