// Tests how pass manage thins candidates, and its behaviour on input that is empty, broken or long.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "fovea/error.h"
#include "tests/passes/manage_cases.h"

namespace fovea::test {
namespace {

// A candidate is kept with probability min(1, K I / sum I), and exactly K are kept when no probability reaches 1.
TEST(Manage, ThinningFollowsTheCdf) {
  constexpr uint32_t kFrames = 200, kCandidates = 40, kKeep = 10;
  Dice dice(6);
  ManageInput in = randomInput(dice, {kCandidates, kCandidates, 0.9f, Importance::Fine});
  for (auto& vpl : in.vpls) vpl = {};
  for (auto& c : in.candidates) c.side = 1;
  in.candidateImportance[7] = 0;
  auto frequencies = [&] {
    ManageSettings settings;
    settings.keep = kKeep;
    settings.maxDensity = 1000;
    Manager manager(settings, in);
    std::map<float, uint32_t> count;
    for (uint32_t f = 0; f < kFrames; ++f) {
      manager.set(in);
      manager.test().run(1);
      for (const VplState& vpl : manager.test().values<VplState>("list"))
        if (vpl.life > 0) ++count[vpl.localPosition.x];
    }
    return count;
  };
  for (float large : {0.0f, 1.0f}) {
    if (large > 0)
      for (float& i : in.candidateImportance) i *= 0.02f;
    if (large > 0) in.candidateImportance[20] = large;
    const double sum = std::accumulate(in.candidateImportance.begin(), in.candidateImportance.end(), 0.0);
    auto count = frequencies();
    uint32_t all = 0;
    for (uint32_t i = 0; i < kCandidates; ++i) {
      const double p = std::min(1.0, kKeep * in.candidateImportance[i] / sum);
      const uint32_t n = count[in.candidates[i].localPosition.x];
      EXPECT_NEAR(n, kFrames * p, 4.5 * std::sqrt(kFrames * p * (1 - p)) + 1e-3) << i << ", large " << large;
      all += n;
    }
    EXPECT_EQ(all == kFrames * kKeep, large == 0);
  }
}

TEST(Manage, EmptyListsAndBadNumbers) {
  Dice dice(7);
  Content content{20, 20, 0.3f, Importance::Fine};
  ManageInput in = randomInput(dice, content);
  Manager manager(ManageSettings{}, in);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  in.candidateImportance[2] = nan;
  in.candidateImportance[3] = inf;
  in.candidateImportance[4] = -1;
  in.vplImportance[2] = nan;
  in.candidates[5].position.x = nan;
  in.candidates[6].position.y = -inf;
  in.candidates[7].position = {-1e3f, 1e4f, 1e20f};
  manager.run(in);
  const ManageInput filled = in;
  for (auto& c : in.candidates) c.side = scene::kNoSide;
  manager.run(in);
  for (auto& vpl : in.vpls) vpl = {};
  EXPECT_EQ(manager.run(in).alive, 0u);
  in.candidates = filled.candidates;
  EXPECT_GT(manager.run(in).alive, 10u);
}

TEST(Manage, LengthsMustAgree) {
  Dice dice(8);
  ManageInput in = randomInput(dice, {4, 6, 0.1f, Importance::Fine});
  in.vplImportance.resize(3);
  EXPECT_THROW(Manager(ManageSettings{}, in).test().run(1), Error);
  in.vplImportance.resize(4);
  in.candidateImportance.resize(5);
  EXPECT_THROW(Manager(ManageSettings{}, in).test().run(1), Error);
  in.candidateImportance.resize(6);
  Manager good(ManageSettings{}, in);
  EXPECT_NO_THROW(good.test().run(1));
}

TEST(Manage, SceneWithoutTriangles) {
  PassTest test("manage");
  test.param("count", 4);
  test.buffer("candidates", std::vector<Candidate>(4), "Candidate");
  test.buffer("candidate_importance", std::vector<float>(4), "float");
  test.buffer("vpls", std::vector<VplState>(4), "VplState");
  test.buffer("vpl_importance", std::vector<float>(4), "float");
  test.run(2);
  for (std::byte b : test.bytes("list")) ASSERT_EQ(b, std::byte(0));
}

// Long lists give correct results, too. Prints the time for lists of a usual length.
TEST(Manage, LongLists) {
  for (const Content& content :
       {Content{4096, 8192, 0.6f, Importance::Fine}, Content{65536, 65536, 0.6f, Importance::Fine}}) {
    if (std::max(content.slots, content.candidates) > longestList()) continue;
    Dice dice(9);
    ManageInput in = randomInput(dice, content);
    Manager manager(ManageSettings{}, in);
    double least = 1e9;
    for (int frame = 0; frame < (content.slots > 5000 ? 2 : 6); ++frame) {
      const ManageOutput out = manager.run(in);
      least = std::min(least, manager.test().gpuMs());
      nextFrame(in, out.vpls, dice);
    }
    std::printf("manage: %u slots, %u candidates: %.2f ms\n", content.slots, content.candidates, least);
    RecordProperty("ms_" + std::to_string(content.slots), std::to_string(least));
  }
}

// Candidates that are placed by their light need no importance; those that compete by it do. A list that makes room when
// the light changes has to know that it does.
TEST(Manage, WhatItNeedsDependsOnThePlacement) {
  Dice dice(9);
  const ManageInput in = randomInput(dice, {20, 50, 0.9f, Importance::Fine, 0.5f});
  const auto run = [&](const char* placement, double changeTurnover) {
    PassTest test("manage");
    test.scene(boundsOnly()).param("count", 20).param("placement", placement);
    test.param("change_turnover", changeTurnover);
    test.buffer("candidates", in.candidates, "Candidate").buffer("vpls", in.vpls, "VplState");
    test.buffer("vpl_importance", in.vplImportance, "float").run(1);
    int added = 0;
    for (const VplState& vpl : test.values<VplState>("list")) {
      if (vpl.life != 1) continue;
      ++added;
      EXPECT_EQ(vpl.importance, 0);
      EXPECT_EQ(vpl.previousImportance, 0);
    }
    return added;
  };
  EXPECT_GT(run("light", 0), 3);
  EXPECT_THROW(run("importance", 0), Error);
  EXPECT_THROW(run("light", 0.1), Error);
}

}  // namespace
}  // namespace fovea::test
