// Tests how long the rest of a suite is said to take.
#include "benchmarks/runner/estimate.h"

#include <gtest/gtest.h>

namespace fovea::bench {
namespace {

Job jobOf(uint32_t side, uint32_t frames) {
  Job job;
  job.size = glm::uvec2(side), job.frames = frames;
  return job;
}

TEST(BenchEstimate, ReferencesAndJobsHaveRatesOfTheirOwn) {
  Estimate estimate;
  const Job job = jobOf(64, 1);
  for (int i = 0; i < 3; ++i) estimate.addJob(job);
  for (const char* name : {"a", "b", "a"}) estimate.addReference(name, 100);
  estimate.addReference("c", 1000);
  EXPECT_EQ(estimate.references(), 3u);
  EXPECT_DOUBLE_EQ(estimate.paths(), 1200);
  EXPECT_FALSE(estimate.secondsLeft());  // nothing was measured yet
  estimate.finish(job, 25, {{"a", 20}}, {"a"});
  // Two jobs of 5 seconds, and 1100 paths, 100 of which took 20 seconds.
  ASSERT_TRUE(estimate.secondsLeft());
  EXPECT_NEAR(*estimate.secondsLeft(), 2 * 5 + 220, 1e-9);
  estimate.finish(job, 5, {}, {"b", "c"});  // made by another process
  EXPECT_EQ(estimate.references(), 0u);
  EXPECT_NEAR(*estimate.secondsLeft(), 5, 1e-9);
  estimate.finish(job, 5, {}, {});
  EXPECT_EQ(estimate.jobs(), 0u);
  EXPECT_EQ(*estimate.secondsLeft(), 0);
}

TEST(BenchEstimate, UnknownWhileNoReferenceWasTimed) {
  Estimate estimate;
  const Job job = jobOf(64, 1);
  estimate.addJob(job), estimate.addJob(job);
  estimate.addReference("a", 100);
  estimate.finish(job, 5, {}, {});
  EXPECT_FALSE(estimate.secondsLeft());
}

TEST(BenchEstimate, LargerJobsAndSearchesTakeLonger) {
  const auto share = [](const Job& done, const Job& left) {
    Estimate estimate;
    estimate.addJob(done), estimate.addJob(left);
    estimate.finish(done, 10, {}, {});
    return *estimate.secondsLeft() / 10;
  };
  EXPECT_GT(share(jobOf(256, 1), jobOf(1024, 16)), 4);
  Job search = jobOf(256, 1);
  search.match = Match();
  EXPECT_NEAR(share(jobOf(256, 1), search), 12, 1e-9);
}

}  // namespace
}  // namespace fovea::bench
