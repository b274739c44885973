// Compares the ray tracer of portable builds with Embree.
#include "framework/scene/rays/ray_tracer.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/scene.h"
#include "framework/base/random.h"
#include "framework/scene/load.h"
#include "tests/support/ray_soup.h"

namespace fovea::scene {
namespace {

using test::randomVector;
using test::raySoup;

Ray randomRay(uint32_t i) {
  Ray ray{6.0f * randomVector(i, 10), randomVector(i, 11)};
  if (i % 4 == 0) ray.direction[int(i / 4 % 3)] = 0;  // within planes of the axes
  if (i % 16 == 0) ray.direction = {0, i % 32 == 0 ? 1 : -1, 0};
  if (i % 5 == 0) ray.near = 1;
  if (i % 7 == 0) ray.far = 3;
  return ray;
}

void compare(const Geometry& g, const RayTracer::Accepts& accepts, uint32_t rays, uint32_t fewestHits) {
#ifndef FOVEA_EMBREE
  GTEST_SKIP() << "built without Embree";
#else
  const auto embree = makeEmbreeTracer(g, accepts), own = makeBvhTracer(g, accepts);
  uint32_t hits = 0, different = 0;
  for (uint32_t i = 0; i < rays; ++i) {
    const Ray ray = randomRay(i);
    const RayHit a = embree->intersect(ray), b = own->intersect(ray);
    hits += bool(a);
    EXPECT_EQ(bool(b), own->occluded(ray)) << "ray " << i;
    // At edges, and where two triangles meet, both answers are valid.
    if (bool(a) != bool(b) || (a && std::abs(a.distance - b.distance) > 1e-4f * (1 + a.distance))) {
      ++different;
      continue;
    }
    if (a && a.triangle == b.triangle) {
      const Triangle& t = g.triangles[a.triangle];
      const glm::vec3 e = g.positions[t.v[1]] - g.positions[t.v[0]],
                      f = g.positions[t.v[2]] - g.positions[t.v[0]];
      EXPECT_LT(glm::length((a.u - b.u) * e + (a.v - b.v) * f), 1e-3f) << "ray " << i;
    }
  }
  EXPECT_GT(hits, fewestHits);
  EXPECT_LE(different, rays / 1000);
#endif
}

TEST(RayTracer, OwnTracerAgreesWithEmbree) {
  compare(raySoup(1), {}, 100000, 100);
  compare(raySoup(3000), {}, 30000, 10000);
}

TEST(RayTracer, OwnTracerAsksTheMaskLikeEmbree) {
  compare(
      raySoup(3000), [](uint32_t t, float u, float v) { return t % 2 == 0 && u < 0.5f && v > 0.1f; }, 30000,
      8000);
}

TEST(RayTracer, ClosedBoxLetsNothingOut) {
  const Geometry g = flatten(builtin("cornellbox"));
  const auto own = makeBvhTracer(g, {});
  const glm::vec3 middle = 0.5f * (g.boundsMin + g.boundsMax);
  Geometry box;  // around the scene: twelve triangles that share edges and corners
  for (int i = 0; i < 8; ++i) box.positions.push_back({i & 1 ? 3 : -3, i & 2 ? 3 : -3, i & 4 ? 3 : -3});
  const uint32_t quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const auto& q : quads) {
    box.triangles.push_back({{q[0], q[1], q[2]}, 0});
    box.triangles.push_back({{q[0], q[2], q[3]}, 0});
  }
  const auto closed = makeBvhTracer(box, {});
  for (uint32_t i = 0; i < 20000; ++i) {
    glm::vec3 direction = randomVector(i, 4);
    if (i % 2 == 0) direction = glm::round(direction * 2.0f);  // straight at edges, corners and diagonals
    if (direction == glm::vec3(0)) continue;
    EXPECT_TRUE(closed->occluded({glm::vec3(0), direction})) << "ray " << i;
    // The reported hit lies on the ray.
    const RayHit hit = own->intersect({middle, direction});
    if (!hit) continue;
    const SurfaceHit s = surfaceAt(g, hit);
    EXPECT_LT(glm::length(s.position - (middle + hit.distance * direction)), 1e-3f) << "ray " << i;
  }
}

// A ray along the plane in which two boxes of the tree touch is in both, whatever the sign of its zero.
TEST(RayTracer, NoRaySlipsBetweenTwoBoxes) {
  Geometry floor;  // strips that share the edges x = -3, -2, ..., 3
  for (int x = -4; x < 4; ++x) {
    const uint32_t v = uint32_t(floor.positions.size());
    for (int k = 0; k < 4; ++k) floor.positions.push_back({x + k % 2, 0, k / 2});
    floor.triangles.push_back({{v, v + 1, v + 2}, 0});
    floor.triangles.push_back({{v + 1, v + 3, v + 2}, 0});
  }
  const auto own = makeBvhTracer(floor, {});
  for (int x = -3; x <= 3; ++x)
    for (const float zero : {0.0f, -0.0f})
      EXPECT_TRUE(own->occluded({{x, 1, 0.25f}, {zero, -1, zero}})) << x << " " << std::signbit(zero);
}

TEST(RayTracer, DegenerateInputIsMissed) {
  Geometry g;
  g.positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  for (int i = 0; i < 100; ++i) g.triangles.push_back({{0, 1, 2}, 0}), g.triangles.push_back({{3, 4, 5}, 0});
  const auto own = makeBvhTracer(g, {});
  EXPECT_FALSE(own->intersect({{0.5f, 1, 0}, {0, -1, 0}}));
  EXPECT_FALSE(own->intersect({{1.5f, 1, 0}, {0, -1, 0}}));
  EXPECT_FALSE(own->intersect({{0, 1, 0}, {0, 0, 0}}));
  EXPECT_FALSE(own->intersect({{std::nanf(""), 1, 0}, {0, -1, 0}}));
  EXPECT_FALSE(makeBvhTracer({}, {})->occluded({{0, 0, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace fovea::scene
