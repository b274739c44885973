// When the times of a job of a benchmark can be trusted.
#include "benchmarks/runner/settled.h"

#include <gtest/gtest.h>

namespace fovea::bench {
namespace {

bool after(std::vector<double> ms, size_t measured) { return settled(ms, measured); }

TEST(Settled, WhatTakesAsLongAsBefore) {
  EXPECT_TRUE(after({900, 30, 20, 20, 22}, 1));
  EXPECT_TRUE(after({900, 30, 20, 20, 22, 400, 21}, 3)) << "a slow frame does not move the median";
}

TEST(Settled, NotWhatIsSlowerThanTheWarmUp) {
  EXPECT_FALSE(after({900, 20, 20, 400}, 1));
  EXPECT_FALSE(after({900, 20, 20, 400, 21}, 2)) << "the median of two is the greater one";
  EXPECT_TRUE(after({900, 20, 20, 400, 21, 20}, 3));
}

TEST(Settled, NotWhatIsSlowerThanWhatFollows) {
  EXPECT_FALSE(after({400, 380, 20}, 3)) << "the first frames without a warm-up";
  EXPECT_TRUE(after({400, 380, 20, 21, 20}, 5));
}

TEST(Settled, NotAFrameThatIsComparedWithNone) {
  EXPECT_FALSE(after({20}, 1));
  EXPECT_FALSE(after({20, 20}, 1));
}

}  // namespace
}  // namespace fovea::bench
