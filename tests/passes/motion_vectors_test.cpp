// Compares where surfaces were seen in the previous frame with projections in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "tests/passes/eye_scene.h"

namespace fovea::test {
namespace {

constexpr uint32_t kNone = 0xffffffffu;

// One frame of the pass; `object` is the object of everything that is seen.
std::vector<uint32_t> originsOf(const Eye& now, const Eye& before, uint32_t object = 0,
                                const std::function<void(scene::Frame&)>& change = {}) {
  PassTest test("motion-vectors");
  now.seen.wire(test);
  before.seen.wire(test, "previous");
  test.image("gbuffer.id", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             std::vector<uint32_t>(size_t(kSize.x * kSize.y), object << 16));
  test.image("gbuffer.triangle", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             std::vector<uint32_t>(size_t(kSize.x * kSize.y)));
  test.scene(now.scene).beforeFrame([&](PassTest&, scene::Frame& frame) {
    frame.views[0] = now.view;
    frame.views[0].previousWorldToClip = before.view.worldToClip;
    if (change) change(frame);
  });
  test.run();
  return test.values<uint32_t>("origin");
}

glm::ivec2 pixelOf(uint32_t origin) { return {int(origin & 0xffff), int(origin >> 16)}; }

// Every pixel maps to itself; the background has no previous position.
TEST(MotionVectors, StandingStill) {
  Eye eye({0, 0, 0});
  eye.seen.pixels[5].distance = 0;
  const auto got = originsOf(eye, eye);
  EXPECT_EQ(got[5], kNone);
  for (int i = 6; i < kSize.x * kSize.y; ++i)
    EXPECT_EQ(pixelOf(got[size_t(i)]), glm::ivec2(i % kSize.x, i / kSize.x));
}

// The eye moves. Each pixel gets one of the four pixels around its previous position, if one of them shows its
// surface; on average this is the exact position. Where the box has uncovered the wall there is none.
TEST(MotionVectors, FollowsSurfacesAsTheEyeMoves) {
  const Eye now({0.13f, 0.05f, 0}), before({0, 0, 0});
  const auto got = originsOf(now, before);
  int followed = 0, lost = 0;
  std::map<bool, glm::dvec2> away;  // on the box, on the wall: sum of the differences
  std::map<bool, int> counts;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const SurfacePixel& p = now.seen.at(x, y);
      const uint32_t origin = got[size_t(y * kSize.x + x)];
      const glm::dvec4 clip = glm::dmat4(before.view.worldToClip) * glm::dvec4(p.position, 1);
      const glm::dvec2 at = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(kSize) - 0.5,
                       corner = glm::floor(at);
      int candidates = 0;
      for (int k = 0; k < 4; ++k) {
        const glm::ivec2 q = glm::ivec2(corner) + glm::ivec2(k & 1, k >> 1);
        candidates += q.x >= 0 && q.y >= 0 && q.x < kSize.x && q.y < kSize.y &&
                      sameSurface(p, before.seen.at(q.x, q.y));
      }
      if (candidates == 0) {
        EXPECT_EQ(origin, kNone) << x << " " << y;
        ++lost;
        continue;
      }
      ASSERT_NE(origin, kNone) << x << " " << y;
      const glm::dvec2 from(pixelOf(origin));
      EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(from - at), glm::dvec2(1.001)))) << x << " " << y;
      EXPECT_TRUE(sameSurface(p, before.seen.at(int(from.x), int(from.y))));
      if (candidates == 4) away[p.distance < 4.5f] += from - at, ++counts[p.distance < 4.5f];
      ++followed;
    }
  EXPECT_GT(followed, 1500);
  EXPECT_GT(lost, 30);
  for (const auto& [box, sum] : away) {
    ASSERT_GT(counts[box], 80);
    EXPECT_LT(glm::length(sum / double(counts[box])), 3 * 0.5 / std::sqrt(counts[box])) << box;
  }
}

// A moving object is found where it was.
TEST(MotionVectors, FollowsObjects) {
  const Eye eye({0, 0, 0});
  const glm::vec3 moved(0.4f, 0, 0);  // all that is seen is object 1, since the frame before
  const auto got = originsOf(eye, eye, 1, [&](scene::Frame& frame) {
    scene::ObjectTransform object;
    object.toWorld = glm::translate(glm::mat4(1), moved);
    object.toObject = glm::inverse(object.toWorld);
    frame.objects.at(1) = object;
  });
  int checked = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const SurfacePixel& p = eye.seen.at(x, y);
      const uint32_t origin = got[size_t(y * kSize.x + x)];
      const glm::dvec4 clip = glm::dmat4(eye.view.worldToClip) * glm::dvec4(p.position - moved, 1);
      const double at = (0.5 * clip.x / clip.w + 0.5) * kSize.x - 0.5;
      if (origin == kNone) continue;
      EXPECT_NEAR(pixelOf(origin).x, at, 1.001);
      EXPECT_NEAR(pixelOf(origin).y, y, 1.001);
      ++checked;
    }
  EXPECT_GT(checked, 1000);
}

// With a jittered view, what stands still keeps its pixel, so that no history wanders. At an edge, where that pixel
// showed something else, the history is that of a pixel beside it which showed the surface.
TEST(MotionVectors, JitterDoesNotMoveWhatStandsStill) {
  Eye now({0, 0, 0}), before({0, 0, 0});
  const glm::vec2 jitterNow(0.45f, -0.3f), jitterBefore(-0.35f, 0.4f);
  scene::jitter(before.view, jitterBefore, {});
  scene::jitter(now.view, jitterNow, jitterBefore);
  now.seen = now.look(), before.seen = before.look();
  const auto got = originsOf(now, before);
  int still = 0, beside = 0, lost = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const SurfacePixel& p = now.seen.at(x, y);
      const uint32_t origin = got[size_t(y * kSize.x + x)];
      if (sameSurface(p, before.seen.at(x, y))) {
        EXPECT_EQ(pixelOf(origin), glm::ivec2(x, y));
        ++still;
      } else if (origin == kNone) {
        ++lost;
      } else {
        const glm::ivec2 from = pixelOf(origin);
        EXPECT_TRUE(sameSurface(p, before.seen.at(from.x, from.y))) << x << " " << y;
        EXPECT_LE(glm::distance(glm::vec2(from), glm::vec2(x, y)), 1.5f) << x << " " << y;
        ++beside;
      }
    }
  EXPECT_GT(still, 1700);
  EXPECT_GT(beside, 10);
  EXPECT_LT(lost, 3);
}

// A pixel behind a transparent surface often shows another surface than before. It takes the history of the nearest of
// the pixels around it that showed its surface; other pixels look at four only.
TEST(MotionVectors, VeiledPixelsLookFurther) {
  Eye now({0, 0, 0}), before({0, 0, 0});
  const glm::ivec2 middle(kSize.x / 2, kSize.y / 2);
  for (int reach = 1; reach <= 3; ++reach)
    for (const bool veiled : {false, true}) {
      before.seen = now.seen;
      for (int y = -reach + 1; y < reach; ++y)  // the pixels around showed something else
        for (int x = -reach + 1; x < reach; ++x)
          before.seen.pixels[size_t((middle.y + y) * kSize.x + middle.x + x)].distance = 0;
      for (SurfacePixel& p : now.seen.pixels) p.grazing = veiled ? -1.0f : 1.0f;
      const auto got = originsOf(now, before);
      const uint32_t origin = got[size_t(middle.y * kSize.x + middle.x)];
      if (reach < (veiled ? 3 : 2)) {
        const glm::ivec2 away = glm::abs(pixelOf(origin) - middle);
        EXPECT_EQ(std::max(away.x, away.y), reach) << veiled;
      } else {
        EXPECT_EQ(origin, kNone) << reach << veiled;
      }
    }
}

}  // namespace
}  // namespace fovea::test
