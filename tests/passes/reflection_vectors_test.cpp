// Compares where reflections were seen in the previous frame with images of mirrors in double precision.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/passes/eye_scene.h"

namespace fovea::test {
namespace {

constexpr uint32_t kNone = 0xffffffffu, kOtherwise = 3 | 5 << 16;

// One frame of the pass, where all pixels have the same distance to what they show and the same origin of the surface.
// tiles: of 16 x 16 pixels that the pass looks at; all if empty.
std::vector<uint32_t> originsOf(const Eye& now, const Eye& before, float thing, uint32_t surface = kOtherwise,
                                const std::vector<uint8_t>& tiles = {}) {
  PassTest test("reflection-vectors");
  const auto pixels = size_t(kSize.x * kSize.y);
  now.seen.wire(test);
  before.seen.wire(test, "previous");
  test.image("gbuffer.id", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             std::vector<uint32_t>(pixels, 0));
  test.image("gbuffer.triangle", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             std::vector<uint32_t>(size_t(kSize.x * kSize.y)));
  test.image("surface", VK_FORMAT_R32_UINT, uint32_t(kSize.x), uint32_t(kSize.y), 1,
             std::vector<uint32_t>(pixels, surface));
  test.image("distances", VK_FORMAT_R32_SFLOAT, uint32_t(kSize.x / 2), uint32_t(kSize.y / 2), 1,
             std::vector<float>(pixels / 4, thing));
  if (!tiles.empty()) test.image("tiles", VK_FORMAT_R8_UNORM, kTiles.x, kTiles.y, 1, tiles);
  test.scene(now.scene).beforeFrame([&](PassTest&, scene::Frame& frame) {
    frame.views[0] = now.view;
    frame.views[0].previousWorldToClip = before.view.worldToClip;
  });
  test.run();
  return test.values<uint32_t>("origin");
}

// The place, in pixels, at which the eye saw a point before.
glm::dvec2 placeOf(glm::dvec3 point, const Eye& before) {
  const glm::dvec4 clip = glm::dmat4(before.view.worldToClip) * glm::dvec4(point, 1);
  return (0.5 * glm::dvec2(clip) / clip.w + 0.5) * glm::dvec2(kSize) - 0.5;
}

// Checks that the wall's pixels were, on average, where an image so far behind the wall was, and not where the wall was.
void expectImagesBehind(double behind, const std::vector<uint32_t>& origins, const Eye& now,
                        const Eye& before) {
  glm::dvec2 fromImage(0), fromWall(0);
  int count = 0;
  for (int y = 4; y < kSize.y - 4; ++y)
    for (int x = 4; x < kSize.x - 4; ++x) {
      const SurfacePixel& p = now.seen.at(x, y);
      const glm::dvec3 wall(p.position), ray = glm::normalize(wall - glm::dvec3(now.view.eye));
      const glm::dvec2 at = placeOf(wall + behind * ray, before);
      const glm::ivec2 corner(glm::floor(at));
      bool seen = p.distance > 4.9f;
      for (int dy = -2; dy <= 2; ++dy)  // what the curvature is measured from, too
        for (int dx = -2; dx <= 2; ++dx) seen = seen && now.seen.at(x + dx, y + dy).distance > 4.9f;
      for (int k = 0; k < 4 && seen; ++k) {
        const glm::ivec2 q = corner + glm::ivec2(k & 1, k >> 1);
        seen = q.x >= 0 && q.y >= 0 && q.x < kSize.x && q.y < kSize.y &&
               sameSurface(p, before.seen.at(q.x, q.y));
      }
      if (!seen) continue;
      const uint32_t origin = origins[size_t(y * kSize.x + x)];
      const glm::dvec2 from(origin & 0xffff, origin >> 16);
      EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(from - at), glm::dvec2(1.1)))) << x << " " << y;
      fromImage += from - at, fromWall += from - placeOf(wall, before);
      ++count;
    }
  ASSERT_GT(count, 500);
  EXPECT_LT(glm::length(fromImage) / count, 3 * 0.5 / std::sqrt(count));
  EXPECT_GT(glm::length(fromWall) / count, 0.3);
}

TEST(ReflectionVectors, FollowsWhatAFlatMirrorShows) {
  const Eye now({0.2f, 0.1f, 0}), before({0, 0, 0});
  for (const float thing : {1.5f, 20.0f})
    expectImagesBehind(thing, originsOf(now, before, thing), now, before);
}

TEST(ReflectionVectors, AConvexMirrorBringsItsImageNearer) {
  Eye now({0.2f, 0.1f, 0}), before({0, 0, 0});
  constexpr float kRadius = 40, kThing = 20;
  for (Eye* eye : {&now, &before})  // normals of a large sphere on the flat wall
    for (SurfacePixel& p : eye->seen.pixels)
      p.normal = glm::normalize(p.position - glm::vec3(0, 0, p.position.z - kRadius));
  expectImagesBehind(kThing / (1 + 2 * kThing / kRadius), originsOf(now, before, kThing), now, before);
}

TEST(ReflectionVectors, WhatDoesNotReflectKeepsTheOriginOfItsSurface) {
  const Eye now({0.2f, 0.1f, 0}), before({0, 0, 0});
  for (const uint32_t surface : {kOtherwise, kNone})
    EXPECT_EQ(originsOf(now, before, 0, surface), std::vector<uint32_t>(size_t(kSize.x * kSize.y), surface));
  EXPECT_EQ(originsOf(now, before, 2, kNone), std::vector<uint32_t>(size_t(kSize.x * kSize.y), kNone));
}

// Where another surface was seen at the place of the image, as where the box was before the wall.
TEST(ReflectionVectors, FallsBackOnTheSurface) {
  Eye now({0.2f, 0.1f, 0}), before({0, 0, 0});
  for (SurfacePixel& p : before.seen.pixels) p.distance = 0;
  EXPECT_EQ(originsOf(now, before, 2), std::vector<uint32_t>(size_t(kSize.x * kSize.y), kOtherwise));
}

TEST(ReflectionVectors, OnlyInItsTiles) {
  const Eye now({0.2f, 0.1f, 0}), before({0, 0, 0});
  std::vector<uint32_t> want = originsOf(now, before, 1.5f);
  clearOutside(want, 1);
  EXPECT_EQ(originsOf(now, before, 1.5f, kOtherwise, kSomeTiles), want);
}

}  // namespace
}  // namespace fovea::test
