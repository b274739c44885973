#include "framework/base/random.h"

#include <gtest/gtest.h>

#include "framework/base/weighted_choice.h"

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

// Over evenly spaced numbers, each thing is chosen as often as its share of the weights says.
TEST(Random, WeightedChoiceFollowsTheWeights) {
  constexpr int kNumbers = 6000;
  const float weights[] = {1, 0.5f, 4, 0.5f};
  int count[4] = {};
  for (int n = 0; n < kNumbers; ++n) {
    WeightedChoice choice((n + 0.5f) / kNumbers);
    int chosen = -1;
    for (int i = 0; i < 4; ++i)
      if (choice.takes(weights[i])) chosen = i;
    ASSERT_GE(chosen, 0);
    EXPECT_FLOAT_EQ(choice.inverseProbability(), 6 / weights[chosen]);
    ++count[chosen];
  }
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(count[i], kNumbers * weights[i] / 6, 5) << i;
  EXPECT_FALSE(WeightedChoice(0.5f).any());
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
