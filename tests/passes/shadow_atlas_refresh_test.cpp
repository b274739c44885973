// Tests which maps the atlas draws again, and that they are the same however they are drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/refresh_reference.h"
#include "tests/passes/vpl_scene.h"

namespace fovea::test {
namespace {

using scene::Scene;
using scene::Vpl;

scene::VplState stateOf(const Vpl& v, float life, float importance) {
  scene::VplState state;
  state.position = v.position;
  state.normal = v.normal;
  state.life = life;
  state.importance = importance;
  return state;
}

void runFrame(PassTest& test, uint32_t frame, const std::vector<Vpl>& vpls,
              const std::vector<scene::VplState>& state) {
  if (frame == 0) {
    test.buffer("vpls", vpls, "Vpl").buffer("state", state, "VplState");
  } else {
    test.set("vpls", vpls);
    test.set("state", state);
  }
  test.run();
}

// Every VPL moves in every frame, so that a map tells when it was drawn.
void checkRefresh(const char* policy, double share) {
  SCOPED_TRACE(policy);
  Scene s = emptyScene();
  addBox(s, 0, {-1, -1, -1}, {1, 1, 1});
  constexpr uint32_t kSlots = 300;
  std::mt19937 random(17);
  std::vector<Vpl> vpls(kSlots);
  std::vector<scene::VplState> state(kSlots);
  std::vector<float> expected;
  RefreshReference reference;
  PassTest test("shadow-atlas");
  test.scene(s).param("size", 8).param("refresh", policy).param("refresh_share", share);
  for (uint32_t frame = 0; frame < 6; ++frame) {
    uint32_t fresh = 0;
    for (uint32_t i = 0; i < kSlots; ++i) {
      const uint32_t what = random() % 10;
      const bool empty = what == 0, isNew = what == 1 || frame == 0 || state[i].life == 0;
      vpls[i] = vpl({0.01f * float(i % 17) + 0.1f * float(frame), 0.2f, 0.002f * float(i)},
                    {0.3f, 1, float(i % 5)});
      if (empty || what == 2) vpls[i].intensity = glm::vec3(0);  // gone, or alive in the dark
      state[i] = empty ? scene::VplState{}
                       : stateOf(vpls[i], isNew ? 1 : state[i].life + 1, float(random() % 12) / 11);
    }
    const std::vector<uint32_t> before = [&] {
      auto copy = reference.drawnIn;
      copy.resize(kSlots);
      return copy;
    }();
    const std::vector<bool> draw = reference.frame(vpls, state, frame, share, policy);
    for (uint32_t i = 0; i < kSlots; ++i) fresh += draw[i] && (state[i].life <= 1 || before[i] == 0);
    runFrame(test, frame, vpls, state);
    // The slots that were drawn hold what an atlas of this frame alone holds; the rest are as they were.
    PassTest whole("shadow-atlas");
    whole.scene(s).param("size", 8).buffer("vpls", vpls, "Vpl");
    whole.run();
    const std::vector<float> all = whole.values<float>("atlas"), got = test.values<float>("atlas");
    expected.resize(all.size(), kInfinity);
    uint32_t drawn = 0;
    for (uint32_t i = 0; i < kSlots; ++i) {
      drawn += draw[i];
      for (uint32_t t = 64 * i; t < 64 * (i + 1); ++t)
        if (draw[i])
          expected[t] = all[t];
        else if (vpls[i].intensity == glm::vec3(0))
          expected[t] = kInfinity;
    }
    ASSERT_EQ(got, expected) << "frame " << frame;
    EXPECT_EQ(test.counter("maps"), drawn);
    EXPECT_EQ(test.counter("new_maps"), fresh);
    EXPECT_EQ(test.counter("refreshed_maps"), drawn - fresh);
    EXPECT_EQ(test.counter("texels"), drawn * 64);
    if (frame > 0) {
      EXPECT_LT(drawn, kSlots / 2);
    }
  }
}

TEST(ShadowAtlasRefresh, NewAndMostImportantMapsAreDrawn) { checkRefresh("top", 0.05); }
TEST(ShadowAtlasRefresh, HalfOfTheBudgetGoesToStaleMaps) { checkRefresh("split", 0.1); }
TEST(ShadowAtlasRefresh, ImportantMapsThatAreOutOfDateAreDrawn) { checkRefresh("stale", 0.1); }

// `split` draws maps that see a mover first and still reaches the others, which count as four times younger.
TEST(ShadowAtlasRefresh, StaleMapsThatSeeAMoverAreDrawnFirst) {
  Scene s = emptyScene();
  addBox(s, 0, {-9, -9, -9}, {9, 9, 9});
  scene::Node root;
  root.dynamic = true;
  s.nodes.push_back(root);
  const size_t mover = s.nodes.size() - 1;
  addBox(s, 0, {-0.2f, 2.8f, -0.2f}, {0.2f, 3.2f, 0.2f});
  for (size_t i = mover + 1; i < s.nodes.size(); ++i) s.nodes[i].parent = uint32_t(mover);
  s.movers = {{uint32_t(mover), true, scene::Repeat::Once, {{0, glm::vec3(0)}, {1, {0.4f, 0, 0}}}}};
  constexpr uint32_t kSlots = 40, kImportant = 5, kFrames = 30;  // the other half of the budget is five, too
  std::vector<Vpl> vpls(kSlots);
  std::vector<scene::VplState> state(kSlots);
  std::vector<float> before;
  std::vector<uint32_t> drawn(kSlots);
  PassTest test("shadow-atlas");
  test.scene(s).param("size", 8).param("refresh", "split").param("refresh_share", 0.25);
  for (uint32_t frame = 0; frame < kFrames; ++frame) {
    for (uint32_t i = 0; i < kSlots;
         ++i) {  // they move, so that maps tell when they are drawn; every other one sees it
      vpls[i] = vpl({0.01f * float(i) + 0.02f * float(frame), 1, 0}, {0, i % 2 == 0 ? 1 : -1, 0.1f});
      state[i] = stateOf(vpls[i], float(frame + 1), i < kSlots - kImportant ? 0.1f : 0.9f);
    }
    runFrame(test, frame, vpls, state);
    const std::vector<float> now = test.values<float>("atlas");
    for (uint32_t i = 0; frame > 0 && i < kSlots; ++i) {
      const bool changed =
          !std::equal(now.begin() + 64 * i, now.begin() + 64 * (i + 1), before.begin() + 64 * i);
      drawn[i] += changed;
      if (i >= kSlots - kImportant) {
        EXPECT_TRUE(changed) << i;
      } else if (frame <= 7 && i % 2 == 1) {
        EXPECT_FALSE(changed) << "slot " << i << " sees no mover, frame " << frame;
      }
    }
    for (uint32_t i = 0; frame == 4 && i < kSlots - kImportant; i += 2) EXPECT_GE(drawn[i], 1u) << i;
    before = now;
  }
  for (uint32_t i = 0; i < kSlots; ++i) EXPECT_GE(drawn[i], 1u) << i;
}

TEST(ShadowAtlasRefresh, NoBudgetDrawsNewMapsOnly) { checkRefresh("top", 0.0); }
TEST(ShadowAtlasRefresh, WholeBudgetDrawsAllMaps) {
  Scene s = emptyScene();
  addBox(s, 0, {-1, -1, -1}, {1, 1, 1});
  const std::vector<Vpl> vpls(40, vpl({0, 0, 0}, {0, 1, 0}));
  std::vector<scene::VplState> state(40, stateOf(vpls[0], 5, 0.5f));
  for (const char* policy : {"top", "split", "all"}) {
    PassTest test("shadow-atlas");
    test.scene(s).param("size", 8).param("refresh", policy).param("refresh_share", 1.0);
    test.buffer("vpls", vpls, "Vpl").buffer("state", state, "VplState");
    test.run();
    EXPECT_EQ(test.counter("maps"), 40) << policy;
    test.run(2);  // nothing moves
    const bool all = std::string(policy) == "all";
    EXPECT_EQ(test.counter("maps"), all ? 40 : 0) << policy;
    EXPECT_EQ(test.counter("unchanged_maps"), all ? 0 : 40) << policy;
  }
}

// A mover flies along behind a wall and out of its shadow and stops in frame 9. The VPLs look in any direction.
struct MoverBehindWall {
  Scene scene = emptyScene();
  std::vector<Vpl> vpls;
  std::vector<scene::VplState> state;

  explicit MoverBehindWall(uint32_t slots) {
    addBox(scene, 0, {-9, -1, -9}, {9, 9, 9});
    addBox(scene, 0, {-1, -1, -0.1f}, {1.5f, 3, 0.1f});  // the wall
    scene::Node root;
    root.dynamic = true;
    scene.nodes.push_back(root);
    const size_t mover = scene.nodes.size() - 1;
    addBox(scene, 0, {-0.5f, 0.5f, 1.5f}, {0.5f, 1.5f, 2.5f});
    for (size_t i = mover + 1; i < scene.nodes.size(); ++i) scene.nodes[i].parent = uint32_t(mover);
    scene.movers = {{uint32_t(mover), true, scene::Repeat::Once, {{0, glm::vec3(0)}, {0.2, {6, 0, 0}}}}};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> in(-1, 1);
    for (uint32_t i = 0; i < slots; ++i) {
      vpls.push_back(
          vpl({2 * in(random), 1 + in(random), -2 + in(random)}, {in(random), in(random), in(random)}));
      state.push_back(stateOf(vpls[i], 5, 0.5f));
    }
  }
};

// Maps that the mover cannot have changed are not drawn, and the atlas holds the same bits as one of which every map
// is drawn in every frame.
void checkUnchanged(bool staticMaps, const char* technique) {
  SCOPED_TRACE(staticMaps ? "static maps" : "whole maps");
  constexpr uint32_t kSlots = 60, kFrames = 16;
  MoverBehindWall world(kSlots);
  PassTest kept("shadow-atlas"), whole("shadow-atlas");
  for (PassTest* test : {&kept, &whole})
    test->scene(world.scene).param("size", 16).param("technique", technique).param("simplify_ratio", 1.0);
  kept.param("refresh", "top").param("refresh_share", 1.0).param("static_maps", staticMaps);
  kept.buffer("vpls", world.vpls, "Vpl").buffer("state", world.state, "VplState");
  whole.param("refresh", "all").buffer("vpls", world.vpls, "Vpl");
  double unchanged = 0, moved = 0, overlaid = 0;
  std::vector<float> before;
  for (uint32_t frame = 0; frame < kFrames; ++frame) {
    if (frame == 5) {  // a VPL that moves needs a map of everything
      world.vpls[7].position.x += 0.1f;
      kept.set("vpls", world.vpls);
      whole.set("vpls", world.vpls);
    }
    kept.run();
    whole.run();
    const std::vector<float> now = whole.values<float>("atlas");
    ASSERT_EQ(kept.values<float>("atlas"), now) << "frame " << frame;
    EXPECT_EQ(kept.counter("maps") + kept.counter("unchanged_maps"), kSlots);
    if (frame > 0) {
      EXPECT_EQ(kept.counter("overlaid_maps"), staticMaps ? kept.counter("maps") - (frame == 5) : 0);
      overlaid += kept.counter("overlaid_maps");
      unchanged += kept.counter("unchanged_maps");
      for (uint32_t i = 0; i < kSlots; ++i)
        moved += !std::equal(now.begin() + 256 * i, now.begin() + 256 * (i + 1), before.begin() + 256 * i);
    }
    before = now;
  }
  const double all = kSlots * (kFrames - 1);
  std::printf("of %.0f maps %.0f change, %.0f are known not to, %.0f drawn over what never moves\n", all,
              moved, unchanged, overlaid);
  EXPECT_GT(moved, 0.1 * all);
  EXPECT_GT(unchanged, 0.5 * (all - moved));
}

TEST(ShadowAtlasRefresh, MapsThatWouldNotChangeAreLeft) { checkUnchanged(false, "exact"); }
TEST(ShadowAtlasRefresh, WhatMovesIsDrawnOverMapsOfWhatNeverDoes) {
  checkUnchanged(true, "exact");
  checkUnchanged(true, "simplified");
}

// A tenth of the stale maps is drawn in a frame by `stale`, and all maps by `whole`.
void drawTenthAndAll(const MoverBehindWall& world, PassTest& stale, PassTest& whole) {
  for (PassTest* test : {&stale, &whole}) test->scene(world.scene).param("size", 16);
  stale.param("refresh", "stale").param("refresh_share", 0.1).param("static_maps", true);
  stale.buffer("vpls", world.vpls, "Vpl").buffer("state", world.state, "VplState");
  whole.param("refresh", "all").buffer("vpls", world.vpls, "Vpl");
}

// The budget is spent on maps that would change: soon after the mover has stopped, all maps are as if drawn anew, and
// after that none is drawn.
TEST(ShadowAtlasRefresh, StaleSpendsNothingOnMapsThatWouldNotChange) {
  constexpr uint32_t kSlots = 60;
  MoverBehindWall world(kSlots);
  PassTest stale("shadow-atlas"), whole("shadow-atlas");
  drawTenthAndAll(world, stale, whole);
  for (uint32_t frame = 0; frame < 9 + kSlots / 6; ++frame) {
    stale.run();
    EXPECT_EQ(stale.counter("unchanged_maps"), 0) << "frame " << frame;
    if (frame > 0) {
      EXPECT_LE(stale.counter("maps"), kSlots / 10) << "frame " << frame;
    }
  }
  whole.run(9 + kSlots / 6);
  EXPECT_EQ(stale.values<float>("atlas"), whole.values<float>("atlas"));
  stale.run();
  EXPECT_EQ(stale.counter("maps"), 0);
}

// Where the light has changed, all maps that would change are drawn in one frame.
TEST(ShadowAtlasRefresh, LightThatChangesHasMoreMapsDrawn) {
  constexpr uint32_t kSlots = 60;
  MoverBehindWall world(kSlots);
  PassTest stale("shadow-atlas"), whole("shadow-atlas");
  drawTenthAndAll(world, stale, whole);
  stale.buffer("change", std::vector<glm::vec4>(1), "LightChange");
  stale.run(4);
  EXPECT_LE(stale.counter("maps"), kSlots / 10);
  whole.run(4);
  EXPECT_NE(stale.values<float>("atlas"), whole.values<float>("atlas"));
  stale.set("change", std::vector<glm::vec4>{{0, 0, 1, 0}});
  stale.run();
  whole.run();
  EXPECT_GT(stale.counter("maps"), kSlots / 10);
  EXPECT_EQ(stale.values<float>("atlas"), whole.values<float>("atlas"));
}

// Slack applies to moving objects in the frames in which they move and leaves everything else unchanged.
TEST(ShadowAtlasRefresh, MoversAreDrawnFartherByTheirWay) {
  const float way = 6 / 0.2f / 42;  // m a frame
  MoverBehindWall world(60), away(60);
  for (scene::MotionKey& key : away.scene.movers[0].keys)
    key.translation += glm::vec3(100);  // behind the walls
  int moved = 0, cut = 0;
  for (const float slack : {0.05f, 3.0f}) {
    PassTest whole("shadow-atlas"), still("shadow-atlas"), slackened("shadow-atlas"),
        overlaid("shadow-atlas");
    for (PassTest* test : {&whole, &still, &slackened, &overlaid})
      test->scene(test == &still ? away.scene : world.scene)
          .param("size", 32)
          .buffer("vpls", world.vpls, "Vpl");
    slackened.param("refresh", "all").param("mover_slack", slack);
    overlaid.param("refresh", "stale").param("refresh_share", 1.0).param("static_maps", true);
    overlaid.param("mover_slack", slack).buffer("state", world.state, "VplState");
    for (PassTest* test : {&whole, &still, &slackened, &overlaid}) test->run(4);
    const std::vector<float> exact = whole.values<float>("atlas"), behind = still.values<float>("atlas"),
                             found = slackened.values<float>("atlas");
    EXPECT_EQ(found, overlaid.values<float>("atlas"));
    for (size_t i = 0; i < exact.size(); ++i) {
      if (exact[i] == behind[i]) {
        ASSERT_EQ(found[i], exact[i]);
        continue;
      }
      const float farther = exact[i] + std::min(slack * way, 0.25f * exact[i]);
      ASSERT_NEAR(found[i], std::min(farther, behind[i]), 1e-5f * farther);
      ++moved;
      cut += slack * way > 0.25f * exact[i];
    }
    for (PassTest* test : {&whole, &slackened}) test->run(10);  // it stands still
    EXPECT_EQ(slackened.values<float>("atlas"), whole.values<float>("atlas"));
  }
  EXPECT_GT(moved, 200);
  EXPECT_GT(cut, 50);
  EXPECT_LT(cut, moved);
}

}  // namespace
}  // namespace fovea::test
