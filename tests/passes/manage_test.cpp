#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <set>
#include <tuple>

#include "framework/base/diagnostic.h"
#include "tests/passes/manage_reference.h"
#include "tests/support/pass_test.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using scene::Candidate;
using scene::VplState;

// Numbers for test data.
class Dice {
 public:
  explicit Dice(uint32_t seed) : seed_(seed) {}
  uint32_t bits() { return hashCombine(seed_, ++count_); }
  uint32_t below(uint32_t n) { return bits() % n; }
  float uniform() { return uniformFloat(bits()); }
  glm::vec3 point() {
    const float x = uniform(), y = uniform();
    return {x, y, uniform()};
  }
  template <class T>
  T any(std::initializer_list<T> values) {
    return values.begin()[below(uint32_t(values.size()))];
  }

 private:
  uint32_t seed_, count_ = 0;
};

// A box with corners (-1, -2, -3) and (4, 2, 3): bounds, nothing else, matter here.
scene::Scene boundsOnly() {
  scene::Scene s;
  const uint32_t material = addMaterial(s, glm::vec3(0.5f));
  addQuad(s, material, {-1, -2, -3}, {5, 0, 0}, {0, 4, 0});
  addQuad(s, material, {-1, -2, 3}, {5, 0, 0}, {0, 4, 0});
  return s;
}
const glm::vec3 kCorner{-1, -2, -3}, kSize{5, 4, 6};

Candidate randomCandidate(Dice& dice, float spread) {
  Candidate c;
  c.position = kCorner + kSize * (0.3f + spread * dice.point());
  c.side = dice.below(8) == 0 ? scene::kNoSide : dice.below(100000);
  c.normal = glm::normalize(dice.point() - 0.5f);
  c.reflectance = dice.point();
  c.luminance = dice.uniform();
  c.localPosition = {float(dice.bits() >> 8), dice.uniform(), 0};  // tells candidates apart
  return c;
}

enum class Importance { Fine, Ties, Small, Zero };
float randomImportance(Dice& dice, Importance kind) {
  switch (kind) {
    case Importance::Fine:
      return dice.uniform();
    case Importance::Ties:
      return 0.25f * float(dice.below(5));
    case Importance::Small:
      return dice.uniform() * dice.uniform() * 1e-5f;
    case Importance::Zero:
      return 0;
  }
  return 0;
}

VplState randomVpl(Dice& dice, float spread, Importance kind, float empty) {
  VplState vpl;
  if (dice.uniform() < empty) return vpl;
  const Candidate c = randomCandidate(dice, spread);
  vpl.position = c.position;
  vpl.normal = vpl.localNormal = c.normal;
  vpl.life = float(2 + dice.below(50));
  vpl.reflectance = c.reflectance;
  vpl.side = dice.below(100000);
  vpl.localPosition = c.localPosition;
  vpl.previousImportance = vpl.importance = randomImportance(dice, kind);
  return vpl;
}

struct Content {  // of random inputs
  uint32_t slots = 16, candidates = 32;
  float spread = 0.3f;
  Importance kind = Importance::Fine;
  float empty = 0.25f;  // share of slots
};

void newCandidates(ManageInput& in, Dice& dice, const Content& content) {
  in.candidates.clear();
  in.candidateImportance.clear();
  for (uint32_t i = 0; i < content.candidates; ++i) {
    in.candidates.push_back(randomCandidate(dice, content.spread));
    in.candidateImportance.push_back(randomImportance(dice, content.kind));
  }
}

ManageInput randomInput(Dice& dice, const Content& content) {
  ManageInput in;
  newCandidates(in, dice, content);
  for (uint32_t i = 0; i < content.slots; ++i) {
    in.vpls.push_back(randomVpl(dice, content.spread, content.kind, content.empty));
    in.vplImportance.push_back(in.vpls[i].life > 0 ? randomImportance(dice, content.kind) : 0.0f);
  }
  return in;
}

// The pass, with the settings of its reference.
class Manager {
 public:
  Manager(const ManageSettings& settings, const ManageInput& in, uint32_t seed = 1)
      : settings_(settings), test_(std::make_unique<PassTest>("manage")) {
    test_->scene(boundsOnly()).seed(seed);
    test_->param("reuse", settings.reuse.c_str()).param("order", settings.order.c_str());
    test_->param("keep", int(settings.keep)).param("limit", int(settings.limit));
    test_->param("count", int(in.vpls.size())).param("max_density", int(settings.maxDensity));
    test_->param("density_constant", settings.densityConstant).param("cell", settings.cell);
    test_->param("placement", settings.placement.c_str()).param("light_floor", settings.lightFloor);
    test_->param("turnover", settings.turnover);
    test_->buffer("candidates", in.candidates, "Candidate");
    test_->buffer("candidate_importance", in.candidateImportance, "float");
    test_->buffer("vpls", in.vpls, "VplState");
    test_->buffer("vpl_importance", in.vplImportance, "float");
  }

  // One frame. Fails unless the pass gives the bits of the reference.
  ManageOutput run(ManageInput in) {
    set(in);
    test_->run(1);
    in.seed = test_->lastFrame().seed;
    in.frame = uint32_t(test_->lastFrame().index);
    in.exposure = test_->lastFrame().exposure;
    in.boundsMin = test_->geometry().boundsMin;
    in.boundsMax = test_->geometry().boundsMax;
    const ManageOutput want = ManageReference(settings_, in).run();
    const auto vpls = test_->values<VplState>("list");
    EXPECT_EQ(vpls.size(), want.vpls.size());
    for (size_t i = 0; i < std::min(vpls.size(), want.vpls.size()); ++i)
      if (std::memcmp(&vpls[i], &want.vpls[i], sizeof(VplState)) != 0) {
        ADD_FAILURE() << "slot " << i << ": life " << vpls[i].life << ", expected " << want.vpls[i].life
                      << "; importance " << vpls[i].importance << ", expected " << want.vpls[i].importance;
        break;
      }
    expectCounters(want);
    return want;
  }
  void set(const ManageInput& in) {
    test_->set("candidates", in.candidates);
    test_->set("candidate_importance", in.candidateImportance);
    test_->set("vpls", in.vpls);
    test_->set("vpl_importance", in.vplImportance);
  }
  PassTest& test() { return *test_; }

 private:
  void expectCounters(const ManageOutput& want) const {
    EXPECT_EQ(test_->counter("kept"), want.kept);
    EXPECT_EQ(test_->counter("deleted"), want.deleted);
    EXPECT_EQ(test_->counter("added"), want.added);
    EXPECT_EQ(test_->counter("candidates"), want.candidates);
    EXPECT_EQ(test_->counter("rejected"), want.rejected);
    EXPECT_EQ(test_->counter("alive"), want.alive);
    EXPECT_EQ(test_->counter("dense"), want.dense);
  }
  ManageSettings settings_;
  std::unique_ptr<PassTest> test_;
};

// What pass update does to a list whose objects rest, and importances that waver.
void nextFrame(ManageInput& in, const std::vector<VplState>& vpls, Dice& dice) {
  in.vpls = vpls;
  for (size_t i = 0; i < vpls.size(); ++i) {
    VplState& vpl = in.vpls[i];
    in.vplImportance[i] = vpl.life > 0 ? std::min(1.0f, vpl.importance * (0.6f + 0.8f * dice.uniform())) : 0;
    if (vpl.life > 0) vpl.life += 1;
    vpl.previousImportance = vpl.importance;
  }
}

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

// Random settings and random lists, then a few frames with the list fed back.
void compareRandomCases(const char* reuse, uint32_t firstSeed) {
  ManageOutput sum;  // to see that the cases exercise what they are for
  for (uint32_t seed = firstSeed; seed < firstSeed + 14; ++seed) {
    SCOPED_TRACE(testing::Message() << reuse << ", seed " << seed);
    Dice dice(seed);
    Content content;
    content.slots = dice.any<uint32_t>({1, 2, 7, 40, 130, 300, 400});
    content.candidates = dice.any<uint32_t>({1, 3, 50, 200, 700, 700});
    ManageSettings settings = randomSettings(dice, content.slots);
    settings.reuse = reuse;
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
  if (std::string(reuse) == "none") return;
  EXPECT_GT(sum.dense, 50u);
  EXPECT_GT(sum.rejected, 150u);
  EXPECT_GT(sum.kept, sum.deleted / 4);
}

TEST(Manage, LinearEqualsTheSerialAlgorithm) { compareRandomCases("linear", 100); }
TEST(Manage, CosineEqualsTheSerialAlgorithm) { compareRandomCases("cosine", 200); }
TEST(Manage, RandomEqualsTheSerialAlgorithm) { compareRandomCases("random", 300); }
TEST(Manage, NoneTakesTheFirstCandidates) { compareRandomCases("none", 400); }

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

// Two lights: VPLs in proportion to them, and to the floor.
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

// A VPL stays in its slot for life, unchanged but for its importance, and no candidate comes twice.
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
  // Longer again: candidates fill it up.
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

// A candidate is kept with probability min(1, K I / sum I), and K of them are when none reaches 1.
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

// The normal that turns are measured against is kept in the space of the object, which is turned and scaled
// here.
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

// Long lists are right, too; and the time of lists of a usual length.
TEST(Manage, LongLists) {
  for (const Content& content :
       {Content{4096, 8192, 0.6f, Importance::Fine}, Content{65536, 65536, 0.6f, Importance::Fine}}) {
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

}  // namespace
}  // namespace fovea::test
