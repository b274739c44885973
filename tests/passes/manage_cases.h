// Random input for pass manage, and a harness that runs the pass next to its reference.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <vector>

#include "fovea/test.h"
#include "framework/gpu/device.h"
#include "framework/session/test_device.h"
#include "tests/passes/manage_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {

using scene::Candidate;
using scene::VplState;

// VPLs that a texel buffer of the device has room for.
inline uint32_t longestList() {
  return testDevice().limits().maxTexelBufferElements / uint32_t(sizeof(VplState) / sizeof(glm::vec4));
}

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

// A box with corners (-1, -2, -3) and (4, 2, 3); only its bounds matter here.
inline scene::Scene boundsOnly() {
  scene::Scene s;
  const uint32_t material = addMaterial(s, glm::vec3(0.5f));
  addQuad(s, material, {-1, -2, -3}, {5, 0, 0}, {0, 4, 0});
  addQuad(s, material, {-1, -2, 3}, {5, 0, 0}, {0, 4, 0});
  return s;
}
const glm::vec3 kCorner{-1, -2, -3}, kSize{5, 4, 6};

inline Candidate randomCandidate(Dice& dice, float spread) {
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
inline float randomImportance(Dice& dice, Importance kind) {
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

inline VplState randomVpl(Dice& dice, float spread, Importance kind, float empty) {
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

inline void newCandidates(ManageInput& in, Dice& dice, const Content& content) {
  in.candidates.clear();
  in.candidateImportance.clear();
  for (uint32_t i = 0; i < content.candidates; ++i) {
    in.candidates.push_back(randomCandidate(dice, content.spread));
    in.candidateImportance.push_back(randomImportance(dice, content.kind));
  }
}

inline ManageInput randomInput(Dice& dice, const Content& content) {
  ManageInput in;
  newCandidates(in, dice, content);
  for (uint32_t i = 0; i < content.slots; ++i) {
    in.vpls.push_back(randomVpl(dice, content.spread, content.kind, content.empty));
    in.vplImportance.push_back(in.vpls[i].life > 0 ? randomImportance(dice, content.kind) : 0.0f);
  }
  return in;
}

// The pass with the settings of its reference.
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
    test_->param("random_share", settings.randomShare);
    test_->param("turnover", settings.turnover).param("saccade_turnover", settings.saccadeTurnover);
    if (settings.changeTurnover > 0) {
      test_->param("change_turnover", settings.changeTurnover);
      test_->buffer("change", std::vector<glm::vec4>(1), "LightChange");
    }
    test_->beforeFrame([this](PassTest&, scene::Frame& frame) { frame.saccade = saccade_; });
    test_->buffer("candidates", in.candidates, "Candidate");
    test_->buffer("candidate_importance", in.candidateImportance, "float");
    test_->buffer("vpls", in.vpls, "VplState");
    test_->buffer("vpl_importance", in.vplImportance, "float");
  }

  // Runs one frame, which fails unless the pass gives the same bits as the reference.
  ManageOutput run(ManageInput in) {
    set(in);
    saccade_ = in.saccade;
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
    if (settings_.changeTurnover > 0) test_->set("change", std::vector<glm::vec4>{{0, 0, in.lost, 0}});
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
  float saccade_ = 0;
  std::unique_ptr<PassTest> test_;
};

// What pass vpl-motion does to a list whose objects rest, with importances that fluctuate.
inline void nextFrame(ManageInput& in, const std::vector<VplState>& vpls, Dice& dice) {
  in.vpls = vpls;
  for (size_t i = 0; i < vpls.size(); ++i) {
    VplState& vpl = in.vpls[i];
    in.vplImportance[i] = vpl.life > 0 ? std::min(1.0f, vpl.importance * (0.6f + 0.8f * dice.uniform())) : 0;
    if (vpl.life > 0) vpl.life += 1;
    vpl.previousImportance = vpl.importance;
  }
}

}  // namespace fovea::test
