// Tests the least times of `fovea bench model`: of work on a kind of device, and of passes that wait for each other.
#include "benchmarks/runner/model/bound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "fovea/error.h"

namespace fovea::bench {
namespace {

constexpr Rates kRates{1e9, 1e12, 1e6};

TEST(Bound, IsTheLongestOfThreeTimes) {
  const Bound bytes = boundOf({2'000'000, 1e9, 1000}, kRates);
  EXPECT_DOUBLE_EQ(bytes.ms, 2);
  EXPECT_EQ(bytes.limit, Limit::Bytes);
  const Bound operations = boundOf({2'000'000, 5e9, 1000}, kRates);
  EXPECT_DOUBLE_EQ(operations.ms, 5);
  EXPECT_EQ(operations.limit, Limit::Operations);
  const Bound rays = boundOf({2'000'000, 5e9, 7000}, kRates);
  EXPECT_DOUBLE_EQ(rays.ms, 7);
  EXPECT_EQ(rays.limit, Limit::Rays);
}

TEST(Bound, OfNoWorkIsNothing) {
  EXPECT_EQ(boundOf({}, kRates).ms, 0);
  EXPECT_EQ(boundOf({}, kRates).limit, Limit::Nothing);
}

//   0 - 1 - 3
//    \ 2 /    4 alone
TEST(LongestChain, GoesThroughTheSlowerOfTwoBranches) {
  const std::vector<graph::Precedence::Edge> edges = {{0, 1}, {0, 2}, {1, 3}, {2, 3}};
  const graph::Precedence order(5, edges);
  EXPECT_DOUBLE_EQ(longestChain(order, std::vector{1.0, 5.0, 2.0, 3.0, 4.0}), 9);
  EXPECT_DOUBLE_EQ(longestChain(order, std::vector{1.0, 5.0, 7.0, 3.0, 4.0}), 11);
  EXPECT_DOUBLE_EQ(longestChain(order, std::vector{1.0, 5.0, 2.0, 3.0, 40.0}), 40);
}

TEST(LongestChain, OfPassesInARowIsTheirSum) {
  const std::vector<graph::Precedence::Edge> edges = {{2, 1}, {1, 0}};
  EXPECT_DOUBLE_EQ(longestChain(graph::Precedence(3, edges), std::vector{1.0, 2.0, 4.0}), 7);
}

TEST(Kinds, HaveRatesSourcesAndNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Kind& kind : kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(&kindNamed(kind.name), &kind);
    for (const double rate : {kind.rates.bytes, kind.rates.operations, kind.rates.rays}) EXPECT_GT(rate, 1e8);
    for (const char* source : {kind.sources.bytes, kind.sources.operations, kind.sources.rays})
      EXPECT_GT(std::string(source).size(), 0u);
  }
  EXPECT_TRUE(names.contains("headset"));
}

TEST(Kinds, AnUnknownOneIsRefusedWithTheNamesOfAll) {
  try {
    kindNamed("toaster");
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::Usage);
    EXPECT_THAT(e.what(),
                testing::AllOf(testing::HasSubstr("toaster"), testing::HasSubstr("headset, laptop")));
  }
}

}  // namespace
}  // namespace fovea::bench
