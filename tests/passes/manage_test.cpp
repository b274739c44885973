// Compares pass manage with the serial algorithm and tests properties that follow from it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>
#include <tuple>

#include "tests/passes/manage_cases.h"

namespace fovea::test {
namespace {

ManageSettings randomSettings(Dice& dice, uint32_t slots) {
  ManageSettings s;
  s.order = dice.any({"literal", "fixed"});
  s.keep = dice.any<uint32_t>({0, 0, 1, slots / 3 + 1, 2 * slots, 2 * slots});
  s.limit = dice.any<uint32_t>({0, 0, 0, 1, slots / 2 + 1, slots + 10});
  s.maxDensity = dice.any<uint32_t>({0, 1, 2, 5});
  s.densityConstant = dice.any({1.0, 1.0, 0.5, 7.3});
  s.cell = dice.any({1.0 / 48, 1.0 / 64, 0.13, 1.0});
  return s;
}

// Random settings and random lists, followed by a few frames in which the list is fed back.
void compareRandomCases(const char* reuse, uint32_t firstSeed,
                        std::initializer_list<double> randomShares = {0.0}) {
  ManageOutput sum;  // to see that the cases exercise what they are for
  for (uint32_t seed = firstSeed; seed < firstSeed + 14; ++seed) {
    SCOPED_TRACE(testing::Message() << reuse << ", seed " << seed);
    Dice dice(seed);
    Content content;
    content.slots = dice.any<uint32_t>({1, 2, 7, 40, 130, 300, 400});
    content.candidates = dice.any<uint32_t>({1, 3, 50, 200, 700, 700});
    ManageSettings settings = randomSettings(dice, content.slots);
    settings.reuse = reuse;
    settings.randomShare = dice.any(randomShares);
    ManageInput in = randomInput(dice, content);
    Manager manager(settings, in, seed);
    for (uint32_t i = 0; i < 5; ++i) {
      SCOPED_TRACE(testing::Message() << "case " << i);
      content.spread = dice.any({0.0f, 0.05f, 0.3f, 0.8f, 0.8f});
      content.empty = dice.any({0.0f, 0.25f, 0.6f, 0.9f});
      content.kind = dice.any(
          {Importance::Fine, Importance::Fine, Importance::Ties, Importance::Small, Importance::Zero});
      in = randomInput(dice, content);
      const ManageOutput out = manager.run(in);
      sum.kept += out.kept;
      sum.dense += out.dense;
      sum.rejected += out.rejected;
      sum.deleted += out.deleted;
      sum.added += out.added;
    }
    content.kind = Importance::Fine;
    for (uint32_t i = 0; i < 5 && !testing::Test::HasFailure(); ++i) {
      const ManageOutput out = manager.run(in);
      nextFrame(in, out.vpls, dice);
      newCandidates(in, dice, content);
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(sum.added, 150u);
  EXPECT_GT(sum.deleted, 150u);
  EXPECT_GT(sum.dense, 50u);
  EXPECT_GT(sum.rejected, 150u);
  EXPECT_GT(sum.kept, sum.deleted / 4);
}

TEST(Manage, LinearEqualsTheSerialAlgorithm) { compareRandomCases("linear", 100); }
TEST(Manage, CosineEqualsTheSerialAlgorithm) { compareRandomCases("cosine", 200); }
TEST(Manage, RandomEqualsTheSerialAlgorithm) { compareRandomCases("random", 300); }
TEST(Manage, ARandomShareEqualsTheSerialAlgorithm) {
  compareRandomCases("random", 400, {0.001, 0.37, 0.5, 0.93, 1.0});
}

TEST(Manage, LightAndTurnoverEqualTheSerialAlgorithm) {
  Dice dice(50);
  for (uint32_t seed = 500; seed < 508; ++seed) {
    SCOPED_TRACE(seed);
    const Content content{dice.any<uint32_t>({7, 40, 300}), dice.any<uint32_t>({3, 200, 700}), 0.8f};
    ManageSettings settings;
    settings.placement = seed % 4 == 0 ? "importance" : "light";
    settings.reuse = seed % 4 == 1 ? "random" : "linear";
    settings.lightFloor = dice.any({0.0, 0.25, 2.0});
    settings.turnover = dice.any({0.0, 0.05, 0.4});
    ManageInput in = randomInput(dice, content);
    if (seed == 507)
      for (Candidate& c : in.candidates) c.luminance = 0;
    Manager manager(settings, in, seed);
    for (uint32_t i = 0; i < 4 && !testing::Test::HasFailure(); ++i) {
      const ManageOutput out = manager.run(in);
      EXPECT_LE(out.deleted, std::ceil(settings.turnover * content.slots));
      nextFrame(in, out.vpls, dice);
      newCandidates(in, dice, content);
    }
  }
}

TEST(Manage, ChangesEqualTheSerialAlgorithm) {
  Dice dice(55);
  for (uint32_t seed = 550; seed < 556; ++seed) {
    SCOPED_TRACE(seed);
    const Content content{dice.any<uint32_t>({7, 40, 300}), dice.any<uint32_t>({3, 200, 700}), 0.8f};
    ManageSettings settings;
    settings.placement = seed % 3 == 0 ? "importance" : "light";
    settings.turnover = dice.any({0.0, 0.05, 1.0});
    settings.changeTurnover = dice.any({0.1, 0.5, 1.0});
    ManageInput in = randomInput(dice, content);
    Manager manager(settings, in, seed);
    for (const float lost : {0.0f, 1.0f, 0.7f, 0.03f, 0.0f}) {
      if (testing::Test::HasFailure()) return;
      in.lost = lost;
      const ManageOutput out = manager.run(in);
      nextFrame(in, out.vpls, dice);
      newCandidates(in, dice, content);
    }
  }
}

// All VPLs fail Eq. 1. Few of them may go at a time, unless the light has changed.
TEST(Manage, LightThatChangesMakesRoom) {
  Dice dice(56);
  ManageInput in = randomInput(dice, {100, 400, 0.9f, Importance::Fine, 0.0f});
  for (size_t i = 0; i < in.vpls.size(); ++i) {
    in.vpls[i].previousImportance = in.vpls[i].importance = 0.5f;
    in.vplImportance[i] = 0;
  }
  ManageSettings settings;
  settings.placement = "light";
  settings.maxDensity = 1000;
  settings.turnover = 0.02;
  settings.changeTurnover = 0.25;
  Manager manager(settings, in);
  for (const auto& [lost, deleted] : {std::pair(0.0f, 2u), {0.04f, 2u}, {0.5f, 6u}, {1.0f, 25u}}) {
    in.lost = lost;
    const ManageOutput out = manager.run(in);
    EXPECT_EQ(out.deleted, deleted) << lost;
    EXPECT_GT(out.added, deleted / 2) << lost;
    EXPECT_EQ(out.rejected, 100u);
  }
}

// Where a door opens, the VPLs of a dark room matter as little as before, so that Eq. 1 keeps all of them.
TEST(Manage, LightThatChangesReplacesTheLeastImportant) {
  Dice dice(57);
  ManageInput in = randomInput(dice, {100, 400, 0.9f, Importance::Fine, 0.0f});
  for (size_t i = 0; i < in.vpls.size(); ++i)
    in.vpls[i].previousImportance = in.vpls[i].importance = in.vplImportance[i] = 0.2f + 0.005f * float(i);
  ManageSettings settings;
  settings.placement = "light";
  settings.maxDensity = 1000;
  settings.turnover = 0.02;
  settings.changeTurnover = 1;
  Manager manager(settings, in);
  for (const auto& [lost, deleted] : {std::pair(0.0f, 0u), {0.09f, 0u}, {0.5f, 25u}, {1.0f, 100u}}) {
    in.lost = lost;
    const ManageOutput out = manager.run(in);
    EXPECT_EQ(out.deleted, deleted) << lost;
    EXPECT_EQ(out.rejected, 0u);
    for (size_t i = 0; i < in.vpls.size(); ++i) EXPECT_EQ(out.vpls[i].life > 1, i >= deleted) << i;
  }
}

TEST(Manage, SaccadesEqualTheSerialAlgorithm) {
  Dice dice(60);
  for (uint32_t seed = 600; seed < 606; ++seed) {
    SCOPED_TRACE(seed);
    const Content content{dice.any<uint32_t>({7, 40, 300}), dice.any<uint32_t>({3, 200, 700}), 0.8f};
    ManageSettings settings;
    settings.placement = seed % 3 == 0 ? "light" : "importance";
    settings.order = seed % 2 == 0 ? "fixed" : "literal";
    settings.turnover = dice.any({0.05, 0.4, 1.0});
    settings.saccadeTurnover = dice.any({0.1, 0.5, 1.0});
    ManageInput in = randomInput(dice, content);
    Manager manager(settings, in, seed);
    for (const float saccade : {0.0f, 1.0f, 0.875f, 0.25f, 0.0f}) {
      if (testing::Test::HasFailure()) return;
      in.saccade = saccade;
      const ManageOutput out = manager.run(in);
      nextFrame(in, out.vpls, dice);
      newCandidates(in, dice, content);
    }
  }
}

// The list is full and nothing changes its importance, so that Eq. 1 keeps all of it. After a jump the least important
// VPLs give way to better candidates, fewer in each frame, and those that are better than the candidates stay.
TEST(Manage, AFullListFollowsTheGaze) {
  Dice dice(61);
  ManageInput in = randomInput(dice, {100, 400, 0.9f, Importance::Fine, 0.0f});
  for (size_t i = 0; i < in.vpls.size(); ++i) {
    in.vplImportance[i] = in.vpls[i].previousImportance = i < 60 ? 0.9f : 0.1f;
    in.vpls[i].importance = in.vplImportance[i];
  }
  std::fill(in.candidateImportance.begin(), in.candidateImportance.end(), 0.5f);
  ManageSettings settings;
  settings.order = "fixed";
  settings.maxDensity = 1000;
  settings.densityConstant = 1024;  // the importance alone decides
  settings.saccadeTurnover = 0.2;
  Manager manager(settings, in);
  uint32_t added = 0;
  for (const float saccade : {0.0f, 1.0f, 0.5f, 0.25f, 0.0f, 1.0f, 1.0f}) {
    in.saccade = saccade;
    const ManageOutput out = manager.run(in);
    EXPECT_EQ(out.alive, 100u);
    EXPECT_EQ(out.added, std::min(uint32_t(20 * saccade), 40u - added)) << saccade;
    added += out.added;
    for (size_t i = 0; i < in.vpls.size(); ++i) {
      EXPECT_TRUE(i >= 60 || out.vpls[i].life > 1) << i;
      in.vplImportance[i] = out.vpls[i].importance;
    }
    nextFrame(in, out.vpls, dice);
    for (size_t i = 0; i < in.vpls.size(); ++i) in.vplImportance[i] = in.vpls[i].importance;
  }
  EXPECT_EQ(added, 40u);
}

// Two lights: the VPLs are in proportion to them, and to the floor.
TEST(Manage, PlacesVplsInProportionToLight) {
  Dice dice(51);
  ManageInput in = randomInput(dice, {200, 2400, 0.8f, Importance::Fine, 1.0f});
  for (size_t i = 0; i < in.candidates.size(); ++i) {
    in.candidates[i].side = uint32_t(i);
    in.candidates[i].luminance = i < 800 ? 6.0f : i < 1600 ? 3.0f : 0.0f;
  }
  ManageSettings settings;
  settings.placement = "light";
  settings.lightFloor = 0.5;  // of a mean of 3
  settings.maxDensity = 1000;
  const ManageOutput out = Manager(settings, in).run(in);
  EXPECT_EQ(out.added, 200u);
  int of[3] = {};
  for (const VplState& vpl : out.vpls) ++of[vpl.side / 800];
  EXPECT_NEAR(of[0], 200 * 7.5 / 13.5, 2);
  EXPECT_NEAR(of[1], 200 * 4.5 / 13.5, 2);
  EXPECT_NEAR(of[2], 200 * 1.5 / 13.5, 2);
}

TEST(Manage, CosineProbabilityIsTheCosine) {
  for (uint32_t x = 0; x < 1u << 24; x += 4093)
    ASSERT_NEAR(cosineProbability24(x), 0x1p24 * (1 - std::cos(std::acos(0.0) * x * 0x1p-24)), 3) << x;
}

TEST(Manage, RandomReusesAsManyAsLinear) {
  Dice dice(1);
  Content content{300, 1, 0.5f, Importance::Fine};
  const ManageInput in = randomInput(dice, content);
  ManageSettings settings;
  const ManageOutput linear = Manager(settings, in).run(in);
  settings.reuse = "random";
  settings.order = "literal";
  const ManageOutput random = Manager(settings, in).run(in);
  EXPECT_EQ(linear.rejected, random.rejected);
  EXPECT_GT(linear.rejected, 20u);
}

TEST(Manage, ARandomHalfIsHalfOfTheVpls) {
  Dice dice(1);
  const ManageInput in = randomInput(dice, {300, 1, 0.9f, Importance::Fine, 0.0f});
  ManageSettings settings;
  settings.reuse = "random";
  settings.randomShare = 0.5;
  settings.placement = "light";  // where VPLs that are not reused have no second chance
  EXPECT_EQ(Manager(settings, in).run(in).kept, 150u);
}

// A VPL stays in its slot as long as it lives, unchanged except for its importance, and no candidate is taken twice.
TEST(Manage, ASlotIsForLife) {
  Dice dice(2);
  Content content{60, 100, 0.4f, Importance::Fine};
  ManageInput in = randomInput(dice, content);
  ManageSettings settings;
  settings.limit = 50;
  Manager manager(settings, in);
  uint32_t kept = 0, added = 0;
  for (int frame = 0; frame < 12; ++frame) {
    const ManageOutput out = manager.run(in);
    kept += out.kept;
    added += out.added;
    EXPECT_LE(out.alive, 50u);
    std::set<float> seen;
    uint32_t alive = 0;
    for (size_t slot = 0; slot < out.vpls.size(); ++slot) {
      const VplState& vpl = out.vpls[slot];
      if (vpl.life == 0) continue;
      ++alive;
      EXPECT_TRUE(seen.insert(vpl.localPosition.x).second) << "slot " << slot;
      if (vpl.life == 1) continue;
      VplState same = in.vpls[slot];
      same.importance = in.vplImportance[slot];
      EXPECT_EQ(std::memcmp(&same, &vpl, sizeof(vpl)), 0) << "slot " << slot;
    }
    EXPECT_EQ(alive, out.alive);
    nextFrame(in, out.vpls, dice);
    newCandidates(in, dice, content);
  }
  EXPECT_GT(kept, 200u);
  EXPECT_GT(added, 40u);
}

TEST(Manage, AShorterLimitKeepsTheMostImportant) {
  Dice dice(3);
  Content content{100, 10, 0.6f, Importance::Fine};
  ManageInput in = randomInput(dice, content);
  for (size_t i = 0; i < in.vpls.size(); ++i) in.vpls[i].previousImportance = in.vplImportance[i];
  ManageSettings settings;
  settings.limit = 20;
  const ManageOutput out = Manager(settings, in).run(in);
  EXPECT_EQ(out.kept, 20u);
  EXPECT_EQ(out.added, 0u);
  std::vector<float> importance = in.vplImportance;
  std::sort(importance.rbegin(), importance.rend());
  for (const VplState& vpl : out.vpls) EXPECT_TRUE(vpl.life == 0 || vpl.importance >= importance[19]);
  // When the list grows again, candidates fill it up.
  in.vpls = out.vpls;
  settings.limit = 25;
  settings.keep = 200;
  const ManageOutput longer = Manager(settings, in).run(in);
  EXPECT_EQ(longer.kept, 20u);
  EXPECT_EQ(longer.alive, 25u);
}

TEST(Manage, NothingChangesWhenNothingDoes) {
  Dice dice(4);
  Content content{64, 200, 0.3f, Importance::Fine};
  ManageInput in = randomInput(dice, content);
  Manager manager(ManageSettings{"linear", "fixed", 0, 0, 64}, in);
  in.vpls = manager.run(in).vpls;
  for (int frame = 0; frame < 6; ++frame) {
    for (size_t i = 0; i < in.vpls.size(); ++i) {
      ASSERT_GT(in.vpls[i].life, 0) << "the list is full";
      in.vpls[i].previousImportance = in.vplImportance[i] = in.vpls[i].importance;
    }
    const ManageOutput out = manager.run(in);
    EXPECT_EQ(out.kept, 64u);
    EXPECT_EQ(std::memcmp(out.vpls.data(), in.vpls.data(), 64 * sizeof(VplState)), 0);
    newCandidates(in, dice, content);
  }
}

// The cells hold at most D_MAX when nothing is reused, and `fixed` fills a list that `literal` leaves short.
TEST(Manage, DensityAndOrder) {
  Dice dice(5);
  Content content{80, 5, 0.2f, Importance::Fine};
  ManageInput in = randomInput(dice, content);
  for (size_t i = 0; i < in.vpls.size(); ++i) {
    in.vpls[i].previousImportance = 1;
    in.vplImportance[i] *= 1e-6f;
  }
  ManageSettings settings;
  settings.maxDensity = 100;
  settings.order = "literal";
  EXPECT_LE(Manager(settings, in).run(in).alive, 5u);
  settings.order = "fixed";
  const ManageOutput all = Manager(settings, in).run(in);
  EXPECT_GT(all.alive, 50u);
  EXPECT_EQ(all.dense, 0u);
  settings.maxDensity = 1;
  settings.cell = 0.05;
  const ManageOutput sparse = Manager(settings, in).run(in);
  EXPECT_GT(sparse.dense, 5u);
  std::set<std::tuple<int, int, int>> cells;
  const float edge = 0.05f * glm::length(kSize);
  for (const VplState& vpl : sparse.vpls) {
    const glm::ivec3 c(glm::floor((vpl.position - kCorner) / edge));
    EXPECT_TRUE(vpl.life == 0 || cells.insert({c.x, c.y, c.z}).second);
  }
}

// One candidate in each of 40^3 cells: no two of them share a cell of the grid.
TEST(Manage, CellsAreTheirOwn) {
  constexpr uint32_t kEdge = 40, kCount = kEdge * kEdge * kEdge;
  if (kCount > longestList()) GTEST_SKIP() << "this device has texel buffers of few elements";
  ManageInput in;
  in.vpls.resize(kCount);
  in.vplImportance.resize(kCount);
  in.candidateImportance.assign(kCount, 0.5f);
  in.candidates.resize(kCount);
  for (uint32_t i = 0; i < kCount; ++i) {
    const glm::vec3 cell(i % kEdge, i / kEdge % kEdge, i / (kEdge * kEdge));
    in.candidates[i].position = kCorner + (cell + 0.5f) * (glm::length(kSize) / 48.0f);
    in.candidates[i].side = i;
  }
  ManageSettings settings;
  settings.maxDensity = 1;
  const ManageOutput out = Manager(settings, in).run(in);
  EXPECT_EQ(out.added, kCount);
  EXPECT_EQ(out.dense, 0u);
}

// The normal that turns are measured against is stored in the space of the object, which is turned and scaled here.
TEST(Manage, NormalInTheSpaceOfTheObject) {
  scene::Scene s = boundsOnly();
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  scene::Node& node = s.nodes.back();
  node.dynamic = true;
  node.scale = {1, 3, 0.5f};
  scene::MotionKey key;
  key.rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  s.movers = {{uint32_t(s.nodes.size() - 1), false, scene::Repeat::Once, {key}}};

  Dice dice(10);
  ManageInput in = randomInput(dice, {8, 8, 0.5f, Importance::Fine, 1.0f});
  for (Candidate& c : in.candidates) {
    c.side = 1;
    c.object = 1;
  }
  in.candidateImportance.assign(8, 1.0f);
  Manager manager(ManageSettings{}, in);
  manager.test().scene(s).run(1);
  ASSERT_EQ(manager.test().lastFrame().objects.size(), 2u);
  const scene::ObjectTransform& object = manager.test().lastFrame().objects[1];
  uint32_t alive = 0;
  for (const VplState& vpl : manager.test().values<VplState>("list")) {
    if (vpl.life == 0) continue;
    ++alive;
    EXPECT_EQ(vpl.object, 1);
    EXPECT_LT(glm::length(object.normalFromObject(vpl.localNormal) - vpl.normal), 1e-5f);
    EXPECT_GT(glm::length(vpl.localNormal - vpl.normal), 1e-2f);
  }
  EXPECT_GT(alive, 4u);
}

}  // namespace
}  // namespace fovea::test
