#include "framework/base/random.h"

#include <gtest/gtest.h>

namespace fovea {
namespace {

TEST(Random, UniformFloatStaysBelowOne) {
  EXPECT_EQ(uniformFloat(0u), 0.0f);
  EXPECT_LT(uniformFloat(~0u), 1.0f);
}

// Chi-square over 64 bins of 64k consecutive indices: 63 degrees of freedom, mean 63, standard deviation 11.2.
TEST(Random, ConsecutiveIndicesAreUniform) {
  constexpr int kBins = 64, kDraws = 1 << 16;
  int count[kBins] = {};
  for (uint32_t i = 0; i < kDraws; ++i)
    ++count[static_cast<int>(uniformFloat(randomStream(1, 2, 3, i)) * kBins)];
  double chi2 = 0;
  const double expected = double(kDraws) / kBins;
  for (int c : count) chi2 += (c - expected) * (c - expected) / expected;
  EXPECT_LT(chi2, 63 + 5 * 11.2);
  EXPECT_GT(chi2, 63 - 5 * 11.2);
}

TEST(Random, EveryPartOfTheKeyMatters) {
  const uint32_t base = randomStream(1, 2, 3, 4);
  EXPECT_NE(base, randomStream(2, 2, 3, 4));
  EXPECT_NE(base, randomStream(1, 3, 3, 4));
  EXPECT_NE(base, randomStream(1, 2, 4, 4));
  EXPECT_NE(base, randomStream(1, 2, 3, 5));
}

}  // namespace
}  // namespace fovea
