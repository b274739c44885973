// Tests how eye paths follow changing light: how soon they find it, and what they report of the change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fovea/test.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "shaders/records/eye_paths.h"
#include "tests/passes/where_rays_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using passes::EyePathEnd;

class EyePathsChange : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, EyePathsChange, testing::Bool(), nameOfPlace);

scene::Scene litRoom() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), red = addMaterial(s, {0.6f, 0.2f, 0.1f});
  const uint32_t walls[6] = {red, grey, grey, red, grey, grey};
  addRoom(s, walls, 2);
  s.lights = {pointLight({0.4f, 1.2f, 0.3f}, {10, 20, 30}), pointLight({-1, 0, 0.5f}, {5, 5, 1})};
  s.cameras.emplace_back();
  return s;
}

// Ends of paths after `frames` frames, from the fourth of which on light is `factor` times as bright, and what the pass
// says of the change.
struct AfterChange {
  AfterChange(uint32_t frames, float factor) {
    RayPassTest test("eye-paths");
    test.param("paths", 500).param("points", 100).param("renew_frames", 1000).param("trace_frames", 4);
    test.viewSize(32, 32).scene(litRoom());
    test.beforeFrame([factor](PassTest&, scene::Frame& f) {
      for (scene::Light& light : f.lights)
        if (f.index >= 3) light.color *= factor;
    });
    test.run(frames);
    ends = test.values<EyePathEnd>("paths.ends");
    change = test.values<glm::vec4>("change")[0];
    rays = test.counter("rays");
  }
  // How many paths found other light than those of `before`.
  int changed(const AfterChange& before) const {
    int count = 0;
    for (size_t i = 0; i < ends.size(); ++i) count += ends[i].radiance != before.ends[i].radiance;
    return count;
  }

  std::vector<EyePathEnd> ends;
  glm::vec4 change{0};
  double rays = 0;
};

// In each frame a share of the points notices that light has become weaker by 1%, and few of the others.
TEST_P(EyePathsChange, PathsAreTracedInTurns) {
  const AfterChange before(3, 1);
  EXPECT_EQ(before.change, glm::vec4(0));
  EXPECT_LT(before.rays, 100 + 125 * 10);
  for (uint32_t turns = 1; turns <= 4; ++turns) {
    const AfterChange after(3 + turns, 0.99f);  // frame f traces the points f, f + 4..
    for (uint32_t i = 0; i < after.ends.size(); ++i)
      if ((i % 100 + 4 - 3) % 4 < turns && before.ends[i].radiance != glm::vec3(0)) {
        EXPECT_NE(after.ends[i].radiance, before.ends[i].radiance) << turns << " " << i;
      }
    EXPECT_NEAR(after.changed(before), 125 * turns, 20) << turns;
    EXPECT_NEAR(after.change.x, 0.01f, 2e-3f) << turns;
  }
  EXPECT_EQ(AfterChange(8, 0.99f).change, glm::vec4(0));
}

// Twice as large a share of the other paths is traced at once as the light has changed by.
TEST_P(EyePathsChange, ChangedLightIsFoundAtOnce) {
  const AfterChange before(3, 1);
  for (const float factor : {0.0f, 0.7f, 1.1f, 2.0f}) {
    const AfterChange after(4, factor);
    const float change = factor < 1 ? 1 - factor : 1 - 1 / factor;
    EXPECT_NEAR(after.change.x, change, 1e-3f);
    EXPECT_FLOAT_EQ(after.change.y, 16 * after.change.x * after.change.x);
    EXPECT_NEAR(after.changed(before), 125 + 375 * std::min(2 * change, 1.0f), 30) << factor;
  }
  const glm::vec4 next = AfterChange(5, 0).change;
  EXPECT_EQ(glm::vec2(next), glm::vec2(0)) << "it has changed before";
}

// The output `change` after so many frames, of which frame i has the lights that `light`
// makes of those of the scene.
template <class Function>
glm::vec4 changeAfter(uint32_t frames, const scene::Scene& scene, const Function& light, int points = 1000) {
  RayPassTest test("eye-paths");
  test.param("paths", 4000).param("points", points).param("renew_frames", 1000);
  test.viewSize(64, 64).scene(scene);
  test.beforeFrame([&](PassTest&, scene::Frame& f) { light(f.lights, uint32_t(f.index)); });
  test.run(frames);
  return test.values<glm::vec4>("change")[0];
}

// Light that comes to one place and goes from another: the paths find as much of the light of one lamp as of the other,
// and in the frames 3 to 6 one becomes weaker and the other brighter by a tenth, and in frame 8 by half. Only what
// exceeds the changes of the frames before counts, of which a quarter is forgotten in frame 7.
TEST_P(EyePathsChange, LightThatMovesSteadilyAgesNothing) {
  scene::Scene lamps = litRoom();
  lamps.lights = {pointLight({-0.8f, 0, 0.5f}, {5, 5, 5}), pointLight({0.8f, 0, 0.5f}, {5, 5, 5})};
  const auto lightOf = [&](size_t lamp) {
    RayPassTest test("eye-paths");
    test.param("paths", 4000).param("points", 1000).viewSize(64, 64).scene(lamps);
    test.beforeFrame([lamp](PassTest&, scene::Frame& f) { f.lights[1 - lamp].color = glm::vec3(0); });
    test.run(1);
    double sum = 0;
    for (const EyePathEnd& e : test.values<EyePathEnd>("paths.ends"))
      sum += double(e.radiance.r + e.radiance.g + e.radiance.b) * double(e.weight);
    return sum;
  };
  lamps.lights[1].color *= float(lightOf(0) / lightOf(1));
  const auto exchanged = [](std::vector<scene::Light>& lights, uint32_t frame) {
    const float share = 0.1f * float(std::clamp(int(frame) - 2, 0, 4)) + (frame < 8 ? 0.0f : 0.5f);
    lights[0].color *= 1 - share;
    lights[1].color *= 1 + share;
  };
  EXPECT_EQ(changeAfter(3, lamps, exchanged), glm::vec4(0));
  const glm::vec4 first = changeAfter(4, lamps, exchanged), next = changeAfter(5, lamps, exchanged),
                  last = changeAfter(7, lamps, exchanged), much = changeAfter(9, lamps, exchanged);
  EXPECT_GT(first.x, 0.02f);
  EXPECT_FLOAT_EQ(first.y, 16 * first.x * first.x) << "it is sudden";
  EXPECT_NEAR(next.x, first.x, 0.2f * first.x);
  EXPECT_LT(next.y, 0.1f * first.y);
  EXPECT_GT(much.x, 3 * last.x);
  EXPECT_NEAR(much.y, 16 * std::pow(much.x - 0.75f * last.x, 2.0f), 0.03f * much.y);
}

// A single point may change by chance, so it says nothing of the light as a whole.
TEST_P(EyePathsChange, OnePointIsNoDrift) {
  const auto fading = [](std::vector<scene::Light>& lights, uint32_t frame) {
    for (scene::Light& light : lights) light.color *= std::pow(0.9f, float(frame));
  };
  const glm::vec4 one = changeAfter(4, litRoom(), fading, 1), many = changeAfter(4, litRoom(), fading);
  EXPECT_NEAR(one.x, 0.1f, 1e-3f);
  EXPECT_EQ(one.w, 0);
  EXPECT_NEAR(one.y, 0, 1e-6f);
  EXPECT_NEAR(many.w, 0.1f, 1e-3f);
}

// Light that goes everywhere ages what is remembered in every frame, not just in the first one.
TEST_P(EyePathsChange, LightThatGoesOneWayAges) {
  const auto fading = [](std::vector<scene::Light>& lights, uint32_t frame) {  // then it is halved
    for (scene::Light& light : lights)
      light.color *= std::pow(0.9f, float(std::clamp(int(frame) - 2, 0, 4))) * (frame < 8 ? 1.0f : 0.5f);
  };
  const auto after = [&](uint32_t frames) { return changeAfter(frames, litRoom(), fading); };
  EXPECT_EQ(after(3), glm::vec4(0));
  for (const uint32_t frames : {4u, 5u}) {
    const glm::vec4 change = after(frames);
    EXPECT_NEAR(change.x, 0.1f, 1e-3f);
    EXPECT_NEAR(change.y, 16 * 0.1f * 0.1f, 5e-3f) << frames;
  }
  EXPECT_EQ(after(8), glm::vec4(0)) << "nothing changes";
  const glm::vec4 half = after(9);
  EXPECT_NEAR(half.x, 0.5f, 1e-3f);
  EXPECT_NEAR(half.y, 16 * 0.5f * 0.5f, 0.2f);
  EXPECT_FLOAT_EQ(half.z, half.y / (1 + half.y));
  EXPECT_EQ(after(10), glm::vec4(0, 0, half.z - 0.25f, 0)) << "a quarter is regained";
}

// What changes all the time has hardly any paths traced out of turn.
TEST_P(EyePathsChange, SteadyChangesCostLittle) {
  const auto rays = [](float perFrame) {
    RayPassTest test("eye-paths");
    test.param("paths", 500).param("points", 100).param("renew_frames", 1000).param("trace_frames", 4);
    test.viewSize(32, 32).scene(litRoom());
    test.beforeFrame([perFrame](PassTest&, scene::Frame& f) {
      for (scene::Light& light : f.lights) light.color *= std::pow(perFrame, float(f.index));
    });
    test.run(12);
    EXPECT_NEAR(test.values<glm::vec4>("change")[0].x, 1 - std::pow(perFrame, 4.0f), 0.02f);
    return test.counter("rays");
  };
  EXPECT_LT(rays(0.9f), 1.15 * rays(1)) << "the quarters of the points lose not quite the same share";
}

// Starts on a wall that comes slowly nearer, and turns, stay on it: from inside of it their paths would lose their light.
TEST_P(EyePathsChange, SlowSurfacesKeepTheirStarts) {
  scene::Scene s = litRoom();
  scene::Mover mover;
  mover.node = uint32_t(s.nodes.size());
  // 0.1 mm a frame, while rays start 0.07 mm off surfaces.
  mover.keys = {{0}, {1, {0, 0, 42 * 1e-4f}, glm::angleAxis(0.002f, glm::vec3(0, 1, 0))}};
  const uint32_t white = addMaterial(s, glm::vec3(0.5f));
  addQuad(s, white, {-1.9f, -1.9f, -1.5f}, {3.8f, 0, 0}, {0, 3.8f, 0});
  s.nodes[mover.node].dynamic = true;
  s.movers = {mover};
  RayPassTest test("eye-paths");
  test.param("paths", 2000).param("points", 500).param("renew_frames", 1000).viewSize(32, 32).scene(s);
  test.run(1);
  const double ends = test.counter("ends");
  EXPECT_GT(ends, 1900);
  for (int frame = 1; frame < 12; ++frame) {
    test.run(1);
    EXPECT_NEAR(test.values<glm::vec4>("change")[0].y, 0, 1e-3f) << frame;
    EXPECT_GT(test.counter("ends"), 0.98 * ends) << frame;
  }
}

// What the eye sees anew by looking elsewhere has not changed.
TEST_P(EyePathsChange, OtherStartsAreNoChange) {
  RayPassTest test("eye-paths");
  test.param("paths", 500).param("points", 100).viewSize(32, 32).scene(litRoom());
  test.beforeFrame([](PassTest&, scene::Frame& f) { f.views[0].gaze.x = f.index < 3 ? 0.5f : 0.12f; });
  test.run(4);
  EXPECT_EQ(test.values<glm::vec4>("change")[0], glm::vec4(0));
}

// Nor does a camera that walks past starts that stay change what their paths find, though it moves the origins of their
// rays by as little as keeps these off the surface.
TEST_P(EyePathsChange, AWalkingEyeIsNoChange) {
  RayPassTest test("eye-paths");
  test.param("paths", 500).param("points", 100).param("stray", 0.25).viewSize(32, 32).scene(litRoom());
  test.beforeFrame([](PassTest&, scene::Frame& f) {
    scene::Camera camera;
    camera.position.x += 0.02f * float(f.index);
    f.views[0] = scene::makeView(camera, f.views[0].size, *f.geometry);
  });
  test.run(3);
  const auto before = test.values<EyePathEnd>("paths.ends");
  test.run(1);
  EXPECT_NEAR(test.values<glm::vec4>("change")[0].x, 0, 1e-4f);
  const auto after = test.values<EyePathEnd>("paths.ends");
  int kept = 0;
  for (size_t i = 0; i < after.size(); ++i)
    kept += glm::distance(after[i].position, before[i].position) < 1e-3f;
  EXPECT_GT(kept, 250);
}

}  // namespace
}  // namespace fovea::test
