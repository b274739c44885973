// Compares the rays of probes, their hits and the light there, with plain rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "tests/passes/probe_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/where_rays_run.h"
#include "tests/support/shapes.h"
#include "tests/support/sky.h"

namespace fovea::test {
namespace {

class ProbeRays : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, ProbeRays, testing::Bool(), nameOfPlace);

constexpr int kSide = 4, kRoom = kSide * kSide * kSide, kRays = 64;

// A room of 4 m in which a box stands; the probe of the first cell is inside it.
scene::Scene roomWithBox() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), red = addMaterial(s, {0.6f, 0.2f, 0.1f});
  const uint32_t walls[6] = {red, grey, grey, red, grey, grey};
  addRoom(s, walls, 2);
  addBox(s, red, {-1.8f, -1.9f, -1.8f}, {-1.1f, -1.0f, -1.2f});
  s.materials[red].emission = {0.25f, 0.5f, 1};
  s.lights = {pointLight({0.4f, 1.2f, 0.3f}, {10, 20, 30}), pointLight({-1, 0, 0.5f}, {5, 5, 1})};
  s.cameras.emplace_back();
  return s;
}

// Probes that all know the same light, and see far.
Probes evenProbes(glm::vec3 light, int count = kRoom) {
  Probes probes(count);
  std::ranges::fill(probes.irradiance, glm::vec4(light, 1));
  std::ranges::fill(probes.distance, glm::vec2(100, 10000));
  return probes;
}

struct Traced {
  scene::ProbeGrid grid;
  std::vector<glm::vec4> directions, hits;
  double rays = 0, inside = 0;
};

Traced trace(const scene::Scene& s, const Probes& probes, uint32_t frames = 1, double spacing = 0) {
  RayPassTest test("probe-rays");
  test.scene(s).viewSize(8, 8).param("probes", kSide).param("rays", kRays).param("spacing", spacing);
  probes.wire(test, "probes");
  test.run(frames);
  return {test.values<scene::ProbeGrid>("rays.grid")[0], test.values<glm::vec4>("rays.directions"),
          test.values<glm::vec4>("rays.hits"), test.counter("rays"), test.counter("inside")};
}

// The grid over the bounds that two opposite corners make.
scene::ProbeGrid gridOver(glm::vec3 low, glm::vec3 high, int probes, double spacing) {
  scene::Scene s;
  addQuad(s, addMaterial(s, glm::vec3(0.5f)), low, {high.x - low.x, 0, 0}, {0, 0, 0.5f * (high.z - low.z)});
  addQuad(s, 0, high, {low.x - high.x, 0, 0}, {0, 0, 0.5f * (low.z - high.z)});
  PassTest test("probe-rays");
  test.scene(s).viewSize(8, 8).param("probes", probes).param("rays", 8).param("spacing", spacing);
  evenProbes(glm::vec3(1), probes * probes * probes).wire(test, "probes");
  test.run();
  return test.values<scene::ProbeGrid>("rays.grid")[0];
}

TEST(ProbeGrids, CellsCoverTheBounds) {
  const scene::ProbeGrid even = gridOver({-2, -2, -2}, {2, 2, 2}, 4, 0);
  EXPECT_EQ(glm::uvec3(even.columns, even.rows, even.layers), glm::uvec3(4));
  EXPECT_EQ(even.spacing, 1);
  EXPECT_EQ(even.origin, glm::vec3(-1.5f));
  const scene::ProbeGrid flat = gridOver({0, 0, 1}, {8, 0, 4}, 16, 0);
  EXPECT_EQ(glm::uvec3(flat.columns, flat.rows, flat.layers), glm::uvec3(16, 1, 6));
  EXPECT_EQ(flat.origin, glm::vec3(0.25f, 0, 1.25f));
  const scene::ProbeGrid wide = gridOver({0, 0, 0}, {8, 5, 8}, 16, 2);  // cells of 2 m, half a one beyond
  EXPECT_EQ(glm::uvec3(wide.columns, wide.rows, wide.layers), glm::uvec3(4, 3, 4));
  EXPECT_EQ(wide.origin, glm::vec3(1, 0.5f, 1));
}

// Unit vectors whose first and second moments are those of the sphere, others in every frame.
TEST(ProbeGrids, DirectionsLieEvenlyAndTurn) {
  PassTest test("probe-rays");
  test.scene(roomWithBox()).viewSize(8, 8).param("probes", 1).param("rays", 256);
  evenProbes(glm::vec3(1), 1).wire(test, "probes");
  test.run();
  auto before = test.values<glm::vec4>("rays.directions");
  for (uint32_t frame = 1; frame < 20; ++frame) {
    test.run();
    auto now = test.values<glm::vec4>("rays.directions");
    glm::dvec3 mean(0);
    glm::dmat3 moments(0);
    double nearest = 2;
    for (size_t i = 0; i < now.size(); ++i) {
      const glm::dvec3 d(now[i]);
      EXPECT_NEAR(glm::length(d), 1, 1e-5);
      mean += d / double(now.size());
      moments += glm::outerProduct(d, d) / double(now.size());
      for (size_t j = 0; j < i; ++j) nearest = std::min(nearest, glm::distance(d, glm::dvec3(now[j])));
    }
    EXPECT_LT(glm::length(mean), 2e-3);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(moments[i][j], i == j ? 1 / 3.0 : 0, 2e-3);
    EXPECT_GT(nearest, 0.15);  // 256 caps of that diameter cover more than a third of the sphere
    EXPECT_GT(glm::distance(before[0], now[0]), 1e-3f);
    std::swap(before, now);
  }
}

TEST_P(ProbeRays, FindWhatPlainRaysFind) {
  const scene::Scene s = roomWithBox();
  const scene::Geometry g = scene::flatten(s);
  Probes probes = evenProbes({0.5f, 1, 2});
  probes.states[5].offset = {0.2f, -0.1f, 0.3f};
  const Traced traced = trace(s, probes);
  ASSERT_EQ(traced.hits.size(), size_t(kRoom * kRays));
  EXPECT_EQ(traced.grid.rays, uint32_t(kRays));
  int backs = 0, lit = 0, dark = 0, emitting = 0;
  for (int i = 0; i < kRoom * kRays; ++i) {
    const int probe = i / kRays;
    const glm::dvec3 from = glm::dvec3(-1.5) + glm::dvec3(probe % 4, probe / 4 % 4, probe / 16) +
                            glm::dvec3(probes.states[size_t(probe)].offset);
    const glm::dvec3 direction(traced.directions[size_t(i % kRays)]);
    const RayHit hit = castRay(s, g, from, direction);
    ASSERT_TRUE(hit);
    const glm::dvec4 got(traced.hits[size_t(i)]);
    const glm::dvec3 normal = faceNormal(g, hit.triangle);
    if (glm::dot(normal, direction) > 0) {
      EXPECT_NEAR(got.a, -0.2 * hit.t, 1e-4);
      EXPECT_EQ(glm::dvec3(got), glm::dvec3(0));
      ++backs;
      continue;
    }
    EXPECT_NEAR(got.a, hit.t, 1e-4);
    const scene::Material& material = s.materials[g.triangles[hit.triangle].material()];
    const glm::dvec3 at = from + hit.t * direction + 1e-4 * normal;
    glm::dvec3 irradiance(0);
    for (const scene::Light& light : s.lights) {
      const glm::dvec3 to = glm::dvec3(light.position) - at;
      const double d2 = glm::dot(to, to), cosine = glm::dot(normal, to) / std::sqrt(d2);
      if (cosine <= 0 || castRay(s, g, at, to, {.tMax = 1})) continue;
      irradiance += glm::dvec3(light.color) * double(light.intensity) * cosine / d2;
    }
    ++(irradiance == glm::dvec3(0) ? dark : lit);
    emitting += material.emission != glm::vec3(0);
    const glm::dvec3 rho(material.baseColor), known(0.5, 1, 2);
    const glm::dvec3 want = glm::dvec3(material.emission) + rho * (irradiance / glm::pi<double>() + known);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 3e-3 * want[c]) << i;
  }
  EXPECT_EQ(backs, kRays);  // those of the probe in the box
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 5);
  EXPECT_GT(emitting, 1000);
}

// Without feedback surfaces reflect nothing of what the probes know. In a room that emits 1 and reflects half, which one
// point for each ray samples, they send 1.5.
TEST_P(ProbeRays, WithoutFeedback) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = glm::vec3(1);
  addRoom(s, walls, 2);
  s.cameras.emplace_back();
  RayPassTest test("probe-rays");
  test.scene(s).viewSize(8, 8).param("probes", kSide).param("rays", 256).param("feedback", false);
  evenProbes(glm::vec3(100)).wire(test, "probes");
  test.run();
  const auto hits = test.values<glm::vec4>("rays.hits");
  double mean = 0;
  for (const glm::vec4& hit : hits) mean += double(hit.r) / double(hits.size());
  EXPECT_NEAR(mean, 1.5, 0.03);
}

// Those that are inside geometry trace a quarter of their rays.
TEST_P(ProbeRays, AProbeInsideTracesFewer) {
  Probes probes = evenProbes(glm::vec3(1));
  probes.states[0].inside = 1;
  const Traced traced = trace(roomWithBox(), probes);
  EXPECT_EQ(traced.inside, 1);
  for (int i = 0; i < kRays; ++i) EXPECT_EQ(traced.hits[size_t(i)].a == 0, i % 4 != 0) << i;
  for (int i = kRays; i < kRoom * kRays; ++i) EXPECT_GT(traced.hits[size_t(i)].a, 0) << i;
}

// Probes more than a cell away from all that the eye may see in the fovea trace a quarter of their rays. Points around
// each probe show which must not, in a wide picture with the gaze on one side.
TEST_P(ProbeRays, OutsideOfTheFoveaProbesTraceFewer) {
  scene::Scene s = roomWithBox();
  s.cameras[0].position = {1.6f, 0.2f, 1.7f};
  const glm::vec2 size(128, 64), gaze(0.8f, 0.3f);
  const scene::View view = scene::makeView(s.cameras[0], size, scene::flatten(s));
  for (const float radius : {0.05f, 0.2f}) {
    RayPassTest test("probe-rays");
    test.scene(s).viewSize(128, 64).param("probes", 8).param("rays", kRays);
    test.param("outside_share", 4).view("fovea_radius", radius);
    test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = gaze; });
    evenProbes(glm::vec3(1), 512).wire(test, "probes");
    test.run();
    const auto hits = test.values<glm::vec4>("rays.hits");
    int fewer = 0;
    for (int probe = 0; probe < 512; ++probe) {
      const glm::vec3 at = glm::vec3(-1.75f) + 0.5f * glm::vec3(probe % 8, probe / 8 % 8, probe / 64);
      bool seen = false;
      for (uint32_t k = 0; k < 1000; ++k) {
        const auto random = [&](uint32_t axis) { return uniformFloat(hashCombine(k, axis)); };
        const glm::vec3 point =
            at + glm::vec3(random(0), random(1), random(2)) - 0.5f;  // within half a metre
        const glm::vec4 clip = view.viewToClip * view.worldToView * glm::vec4(point, 1);
        const glm::vec2 pixel = 0.5f * size * (glm::vec2(clip) / clip.w + 1.0f);
        seen = seen || (clip.w > 0 && glm::distance(pixel, gaze * size) < radius * size.x);
      }
      int traced = 0;
      for (int i = 0; i < kRays; ++i) traced += hits[size_t(probe * kRays + i)].a != 0;
      EXPECT_TRUE(traced == kRays || traced == kRays / 4) << probe;
      EXPECT_TRUE(!seen || traced == kRays) << probe;
      fewer += traced < kRays;
    }
    EXPECT_GT(fewer, 200) << radius;
    EXPECT_LT(fewer, 500) << radius;
  }
}

TEST_P(ProbeRays, TheSkyBringsItsLight) {
  scene::Scene s;
  const uint32_t black = addMaterial(s, glm::vec3(0));
  addBox(s, black, {-2, -2, -2}, {2, -1.9f, 2});
  addBox(s, black, {-2, 1.9f, -2}, {-1.9f, 2, -1.9f});  // the bounds are those of a cube
  s.environmentMap = skyWithSun();
  s.cameras.emplace_back();
  const Traced traced = trace(s, evenProbes(glm::vec3(1)));
  // On the device the map is in half floats, and angles are approximate.
  const float tolerance = GetParam() ? 1e-4f : 1e-2f;
  int open = 0;
  for (size_t i = 0; i < traced.hits.size(); ++i) {
    const glm::vec4 hit = traced.hits[i];
    if (hit.a < 1e29f) continue;
    ++open;
    const glm::vec3 want = s.environmentMap->radiance(glm::vec3(traced.directions[i % kRays]));
    EXPECT_LT(glm::distance(glm::vec3(hit), want), tolerance * glm::length(want)) << i;
  }
  EXPECT_GT(open, kRoom * kRays / 2);
  EXPECT_LT(open, kRoom * kRays);
}

// Whatever thread traces which of them.
TEST_P(ProbeRays, TheSameInEveryRun) {
  const Traced one = trace(roomWithBox(), evenProbes(glm::vec3(1))),
               other = trace(roomWithBox(), evenProbes(glm::vec3(1)));
  EXPECT_EQ(one.rays, other.rays);
  EXPECT_EQ(std::memcmp(one.hits.data(), other.hits.data(), one.hits.size() * sizeof one.hits[0]), 0);
}

// Surfaces reflect the light that the probes around them bring there, seen from where the ray comes.
TEST_P(ProbeRays, SurfacesReflectTheLightOfTheProbes) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), walls[6] = {grey, grey, grey, grey, grey, grey};
  addRoom(s, walls, 2);
  s.cameras.emplace_back();
  const Probes probes = knownProbes(kRoom, 1);
  const Traced traced = trace(s, probes);
  for (size_t i = 0; i < traced.hits.size(); ++i) {
    const size_t probe = i / kRays;
    const glm::dvec3 from = glm::dvec3(traced.grid.origin) +
                            glm::dvec3(probe % kSide, probe / kSide % kSide, probe / kSide / kSide) +
                            glm::dvec3(probes.states[probe].offset),
                     direction(traced.directions[i % kRays]);
    if (probes.states[probe].inside > 0 && i % kRays % 4 != 0) continue;
    // The nearest wall ahead.
    glm::dvec3 normal(0);
    double t = 1e9;
    for (int axis = 0; axis < 3; ++axis)
      if (const double at = (std::copysign(2.0, direction[axis]) - from[axis]) / direction[axis]; at < t) {
        t = at;
        normal = glm::dvec3(0);
        normal[axis] = -std::copysign(1.0, direction[axis]);
      }
    const glm::dvec3 want =
        0.5 * probeLight(traced.grid, probes, from + t * direction, normal, -direction, 0.25);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(traced.hits[i][c], want[c], 3e-3 * want[c]) << i;
  }
}

TEST_P(ProbeRays, NothingToMeet) {
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  const Traced traced = trace(s, evenProbes(glm::vec3(1)));
  EXPECT_EQ(traced.rays, 0);
  for (const glm::vec4& hit : traced.hits) EXPECT_EQ(hit, glm::vec4(0));
}

TEST_P(ProbeRays, ProbesOfAnotherGridAreRefused) {
  try {
    trace(roomWithBox(), evenProbes(glm::vec3(1), kRoom + 1));
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("(probes.states.count is 65, "), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace fovea::test
