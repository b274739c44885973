// `ours_literal` is the paper's Algorithms 1 and 2, choice by choice: its frames agree with a serial program of them,
// and so do those of the same graph with any one choice set back to that of `ours` or to another of the paper's rules,
// from which the program as printed differs.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "tests/graphs/literal_serial.h"

namespace fovea::test {
namespace {

struct Choice {
  const char* name;
  std::vector<std::string> set;  // parameters of the graph
  LiteralChoices choices;        // the same for the serial program
  const char* step;              // in which the program as printed differs
};

class Literal : public testing::TestWithParam<Choice> {};

TEST_P(Literal, FramesAreThoseOfTheSerialProgram) {
  const Choice& choice = GetParam();
  const scene::Scene scene = literalScene();
  const std::vector<LiteralFrame> frames = literalFrames(scene, choice.set);
  ASSERT_EQ(frames.size(), kLiteralFrames);
  SerialProgram program(scene, choice.choices), printed(scene, LiteralChoices{});
  for (const LiteralFrame& frame : frames) {
    program.frame(frame);
    printed.frame(frame);
  }
  for (const auto& [step, tally] : program.tallies()) {
    std::printf("[ MEASURED ] %-18s %zu of %zu differ\n", step.c_str(), tally.off, tally.compared);
    EXPECT_TRUE(tally.agrees()) << step << ": " << tally.off << " of " << tally.compared
                                << " differ, the first is " << tally.first;
    if (step != "area" || choice.choices.oneArea) {
      EXPECT_GT(tally.compared, kLiteralFrames) << step;
    }
  }
  if (choice.step) {
    const Tally& tally = printed.tallies().at(choice.step);
    EXPECT_FALSE(tally.agrees()) << choice.step << ": the choice makes no difference, " << tally.off << " of "
                                 << tally.compared << " differ";
  }
}

const Choice kChoices[] = {
    {"AsPrinted", {}, {}, nullptr},
    {"StartsInTheImage", {"region=mixed"}, {.region = scene::kRegionMixed}, "candidates"},
    {"CandidatesAtAverages", {"candidate_position=average"}, {.intersection = false}, "candidates"},
    {"WeightsFromTheEdge", {"weight_falloff=edge"}, {.fromCentre = false}, "weights"},
    {"Luminance", {"luminance=true", "luminance_floor=0.1"}, {.luminanceFloor = 0.1}, "importance"},
    {"CosineRule", {"reuse=cosine"}, {.reuse = "cosine"}, "management"},
    {"Density", {"max_density=0"}, {.maxDensity = 0}, "management"},
    {"DirectLight", {"terms=both"}, {.directLight = true}, "radiosity"},
    {"Areas", {"intensity=importance-area"}, {.oneArea = false}, "area"},
    {"StaleMaps", {"refresh=stale"}, {.top = false}, "maps"},
    {"Clamp",
     {"clamp_distance=0.25", "clamp_unit=mean-free-paths"},
     {.clampDistance = 0.25, .clampInMeanFreePaths = true},
     "picture"},
};

INSTANTIATE_TEST_SUITE_P(Choices, Literal, testing::ValuesIn(kChoices),
                         [](const auto& info) { return std::string(info.param.name); });

// What makes these frames a test: VPLs are kept, deleted and added, on a moving object too, cells are full, and maps
// are redrawn.
TEST(LiteralFrames, HaveAllThatAlgorithm2DecidesOn) {
  const std::vector<LiteralFrame> frames = literalFrames(literalScene(), {});
  double kept = 0, deleted = 0, added = 0, rejected = 0, dense = 0, redrawn = 0, escaped = 0;
  size_t onTheCube = 0, lost = 0;
  for (const LiteralFrame& f : frames) {
    kept += f.counter("manage.kept");
    deleted += f.counter("manage.deleted");
    rejected += f.counter("manage.rejected");
    dense += f.counter("manage.dense");
    redrawn += f.counter("shadow-atlas.refreshed_maps");
    escaped += f.counter("candidates.escaped");
    lost += size_t(f.counter("vpl-motion.deleted"));
    if (f.moment.index > 0) added += f.counter("manage.added");
    for (const scene::VplState& v : f.list) onTheCube += v.life > 1 && v.object > 0;
  }
  std::printf("[ MEASURED ] kept %.0f, deleted %.0f, added %.0f, rejected %.0f, refused %.0f, redrawn %.0f, ",
              kept, deleted, added, rejected, dense, redrawn);
  std::printf("kept on the cube %zu, lost by it %zu\n", onTheCube, lost);
  EXPECT_GT(kept, 40);
  EXPECT_GT(deleted, 10);
  EXPECT_GT(added, 10);
  EXPECT_GT(rejected, 10);
  EXPECT_GT(dense, 5);
  EXPECT_GT(redrawn, 10);
  EXPECT_GT(escaped, 20);
  EXPECT_GT(onTheCube + lost, 0u);
}

}  // namespace
}  // namespace fovea::test
