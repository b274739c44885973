// Tests the path tracer's statistics, the rules it shares with the raster passes, and the pass around it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fovea/scene.h"
#include "fovea/test.h"
#include "framework/scene/load.h"
#include "tests/passes/path_trace_run.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

// ---- Statistics -------------------------------------------------------------------------------------------

TEST(PathTrace, MeanOfTheCornellBoxDoesNotDependOnTheSeed) {
  const scene::Scene s = scene::builtin("cornellbox");
  std::vector<Traced> runs;
  for (const bool lowDiscrepancy : {false, true})
    for (uint32_t seed = 0; seed < 6; ++seed) {
      PathTraceSettings settings = independent(4, 32, seed);
      settings.independent = !lowDiscrepancy;
      runs.push_back(trace(s, 32, settings));
    }
  double largest = 0, z2 = 0;
  int pairs = 0;
  for (size_t i = 0; i < runs.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const double a = meanOf(runs[i].radiance).g, b = meanOf(runs[j].radiance).g;
      const double ea = errorOfMean(runs[i]).g, eb = errorOfMean(runs[j]).g;
      const double z = std::abs(a - b) / std::sqrt(ea * ea + eb * eb);
      largest = std::max(largest, z);
      z2 += z * z;
      ++pairs;
      EXPECT_NE(a, b);
    }
  EXPECT_LT(largest, 4.2);
  EXPECT_LT(z2 / pairs, 2.5);  // 1 on average; pairs are not independent
  EXPECT_GT(z2 / pairs, 0.3);
}

// MSE(h1, h2) / 4 is the squared error of the mean; it falls as 1 / spp, and the variance agrees with it.
TEST(PathTrace, ErrorFallsAsOneOverTheSamples) {
  const scene::Scene s = scene::builtin("cornellbox");
  std::vector<double> x, y;
  for (const uint32_t samples : {8u, 32u, 128u, 512u}) {
    const Traced t = trace(s, 40, independent(4, samples));
    double halves = 0;
    for (size_t i = 0; i < t.halfA.size(); ++i)
      halves += std::pow(double(t.halfA[i].g) - t.halfB[i].g, 2) / 4 / double(t.halfA.size());
    EXPECT_NEAR(halves, meanOf(t.variance).g, 0.25 * halves) << samples;
    x.push_back(std::log2(samples));
    y.push_back(std::log2(meanOf(t.variance).g));
    for (size_t i = 0; i < t.halfA.size(); ++i)
      ASSERT_NEAR(t.radiance[i].g, (t.halfA[i].g + t.halfB[i].g) / 2, 1e-5f * t.radiance[i].g + 1e-6f);
    if (samples < 512) continue;
    PathTraceSettings settings = independent(4, samples);
    settings.independent = false;
    EXPECT_LT(meanOf(trace(s, 40, settings).variance).g,
              0.8 * meanOf(t.variance).g);  // what Sobol' points are for
  }
  double slope = 0;
  for (size_t i = 1; i < x.size(); ++i) slope += (y[i] - y[i - 1]) / (x[i] - x[i - 1]) / double(x.size() - 1);
  EXPECT_NEAR(slope, -1, 0.05);
}

// Also with low-discrepancy sampling, over many seeds, the reported variance is the actual one.
TEST(PathTrace, VarianceIsThatBetweenSeeds) {
  const scene::Scene s = scene::builtin("cornellbox");
  constexpr uint32_t kSeeds = 24, kSide = 24;
  for (const bool box : {false, true}) {
    std::vector<glm::dvec3> sum(kSide * kSide), squares(kSide * kSide);
    double claimed = 0, found = 0;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
      PathTraceSettings settings = independent(4, 32, seed);
      settings.independent = false;
      settings.box = box;
      const Traced t = trace(s, kSide, settings);
      claimed += meanOf(t.variance).g / kSeeds;
      for (size_t i = 0; i < sum.size(); ++i) {
        sum[i] += glm::dvec3(t.radiance[i]);
        squares[i] += glm::dvec3(t.radiance[i]) * glm::dvec3(t.radiance[i]);
      }
    }
    for (size_t i = 0; i < sum.size(); ++i)
      found += (squares[i].g - sum[i].g * sum[i].g / kSeeds) / (kSeeds - 1) / double(sum.size());
    EXPECT_NEAR(claimed, found, 0.1 * found) << box;
  }
}

// ---- Determinism and interruption -------------------------------------------------------------------------

TEST(PathTrace, SameBitsForAnyNumberOfThreads) {
  const scene::Scene s = scene::builtin("cornellbox");
  for (const bool lowDiscrepancy : {false, true}) {
    PathTraceSettings settings = independent(4, 21);
    settings.independent = !lowDiscrepancy;
    settings.threads = 1;
    const Traced one = trace(s, 33, settings);
    for (const uint32_t threads : {2u, 5u}) {
      settings.threads = threads;
      const Traced many = trace(s, 33, settings);
      EXPECT_EQ(one.radiance, many.radiance);
      EXPECT_EQ(one.indirect, many.indirect);
      EXPECT_EQ(one.variance, many.variance);
      EXPECT_EQ(one.halfB, many.halfB);
      EXPECT_EQ(one.statistics.rays, many.statistics.rays);
    }
    settings.seed = 2;
    EXPECT_NE(one.radiance, trace(s, 33, settings).radiance);
  }
}

TEST(PathTrace, StoppedEarlyItKeepsWhatItHas) {
  const scene::Scene s = scene::builtin("cornellbox");
  PathTraceSettings settings = independent(4, 1 << 24);
  double last = 0;
  int calls = 0;
  settings.progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return ++calls < 3;
  };
  const Traced t = trace(s, 48, settings);
  EXPECT_EQ(calls, 3);
  EXPECT_GE(t.statistics.samples, 2);
  EXPECT_LT(t.statistics.samples, 1 << 20);
  const Traced whole = trace(s, 48, independent(4, 64));
  EXPECT_NEAR(meanOf(t.radiance).g, meanOf(whole.radiance).g, 5 * (errorOfMean(t).g + errorOfMean(whole).g));
  for (const glm::vec4& v : t.variance) ASSERT_TRUE(std::isfinite(v.r));
}

// ---- Rules shared with the raster passes ------------------------------------------------------------------

// A floor and, halfway up to the eye and the lights, a sheet with holes where its texture is transparent.
scene::Scene withSheet() {
  scene::Scene s = plane(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(0.8f, 0.1f, 0.1f));
  scene::Texture holes;
  holes.width = holes.height = 2;
  holes.rgba = {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255};
  s.textures.push_back(holes);
  scene::Material& sheet = s.materials[1];
  sheet.baseColorTexture.texture = 0;
  sheet.masked = sheet.doubleSided = true;
  addQuad(s, 1, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
  return s;
}

std::vector<float> differences(const Traced& t, const std::vector<float>& image) {
  std::vector<float> d;
  for (size_t i = 0; i < t.direct.size(); ++i)
    d.push_back(
        glm::length(glm::vec3(t.direct[i]) - glm::vec3(image[4 * i], image[4 * i + 1], image[4 * i + 2])) /
        (glm::length(glm::vec3(t.direct[i])) + 0.01f));
  std::sort(d.begin(), d.end());
  return d;
}

// Compares visibility, materials, textures, masks, normals and lights: everything but the texels of the shadow maps
// along the edges of shadows.
TEST(PathTrace, DirectLightIsThatOfTheRasterPasses) {
  scene::Scene s = withSheet();
  addMaterial(s, glm::vec3(0.2f, 0.3f, 0.9f));
  addHollowSphere(s, 2, {1.2f, 0.5f, 0.4f}, 0.4f, 32, 16);  // its front is inside
  s.materials[2].emission = {0, 0.1f, 0};
  s.environment = {0.1f, 0.2f, 0.3f};
  s.lights = {sun({0.3f, -1, 0.2f}, {1, 1, 0.5f}), pointLight({0.5f, 2, 0}, glm::vec3(2)),
              spotLight({-1, 2.5f, 0}, {0.3f, -1, 0}, 0.3f, 0.5f, {0, 5, 5})};
  for (const bool fromAside : {false, true}) {
    if (fromAside) lookAlong(s, {6, 3, 8}, {-0.5f, -0.2f, -0.8f}, 1);
    PathTraceSettings settings = independent(2, 2);
    const Traced t = trace(s, 96, settings);
    GraphRunOptions options;
    options.size = {96, 96};
    options.outputs = {"direct"};
    const auto d = differences(t, toFloats(runGraph("direct", s, options).outputs.at("direct")));
    EXPECT_LT(d[d.size() * 9 / 10], 0.003f) << fromAside;
    EXPECT_LT(d[d.size() * 98 / 100], 0.1f) << fromAside;
  }
}

TEST(PathTrace, HolesOfMasksLetEyeAndLightThrough) {
  scene::Scene s = withSheet();
  s.lights = {sun({0.5f, -1, 0.2f}, glm::vec3(1))};
  const double e = 1 / std::sqrt(1.29) / kPi;
  const Traced t = trace(s, 64, independent(2, 2));
  int sheet = 0, lit = 0, shadowed = 0;
  for (const glm::vec4& v : t.direct) {
    if (std::abs(v.r - 0.8 * e) < 1e-3) ++sheet;
    if (std::abs(v.r - 0.5 * e) < 1e-3) ++lit;
    if (v.r == 0) ++shadowed;
  }
  // A quarter of the sheet spans (64 / 2 / tan 0.5 / 2)^2 pixels, half of which are holes (edges at the cutoff of
  // a bilinear ramp).
  const double spans = std::pow(64 / (2 * std::tan(0.5)), 2);
  EXPECT_NEAR(sheet, 0.5 * spans, 0.08 * spans);
  EXPECT_GT(lit, 200);
  EXPECT_GT(shadowed, 20);
  EXPECT_EQ(sheet + lit + shadowed, 64 * 64);
}

// The back of a single-sided board: the eye looks through it, but it stops light and is black.
TEST(PathTrace, BacksOfSingleSidedMaterialsAreBlackAndUnseen) {
  const auto at = [](const Traced& t) { return t.radiance[t.radiance.size() / 2 + t.size.x / 2].r; };
  scene::Scene s = plane(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(1));
  s.lights = {sun({0, -1, 0}, glm::vec3(1))};
  const float lit = at(trace(s, 17, independent(2, 2)));
  EXPECT_NEAR(lit, 0.5 / kPi, 1e-5);
  addQuad(s, 1, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2});  // faces down, between the eye and the floor
  const Traced shadow = trace(s, 17, independent(4, 64));
  EXPECT_EQ(shadow.direct[17 * 8 + 8].r, 0);
  EXPECT_GT(shadow.indirect[17 * 8 + 8].r, 0);  // the lit floor around, by way of the board's front
  s.materials[1].doubleSided = true;
  EXPECT_NEAR(at(trace(s, 17, independent(2, 2))), 1 / kPi, 1e-5);  // now the board is seen
  // Light that the floor reflects up to a back does not return.
  s = plane(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(1));
  addQuad(s, 1, {-9, 1, 9}, {18, 0, 0}, {0, 0, -18});  // faces up
  lookAlong(s, {0, 0.5f, 0}, {0, -1, 0}, 1);
  s.lights = {pointLight({0, 0.9f, 0}, glm::vec3(1))};
  EXPECT_EQ(meanOf(trace(s, 8, independent(4, 64)).indirect), glm::dvec3(0));
  s.materials[1].doubleSided = true;
  EXPECT_GT(meanOf(trace(s, 8, independent(4, 64)).indirect).r, 0.1);
}

TEST(PathTrace, EnvironmentIsSeenButLightsNothing) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  s.environment = {1, 2, 3};
  lookAlong(s, {0, 1, 0}, {0, 0, -1}, 1);
  const Traced t = trace(s, 8, independent(4, 4));
  EXPECT_EQ(t.radiance.front(), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(t.halfB.front(), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(t.radiance.back(), glm::vec4(0, 0, 0, 1));
}

// ---- As a pass --------------------------------------------------------------------------------------------

TEST(PathTracePass, PutsOutWhatTheTracerMakes) {
  const scene::Scene s = scene::builtin("cornellbox");
  PassTest test("path-trace");
  test.param("spp", 16).param("sampling", "independent").viewSize(24, 24).scene(s).seed(5);
  test.run();
  const auto radiance = test.values<glm::vec4>("radiance"), direct = test.values<glm::vec4>("direct"),
             indirect = test.values<glm::vec4>("indirect"), variance = test.values<glm::vec4>("variance"),
             halfA = test.values<glm::vec4>("half_a"), halfB = test.values<glm::vec4>("half_b");
  const Traced t = trace(s, 24, independent(4, 256));
  glm::dvec3 error(0);
  for (size_t i = 0; i < radiance.size(); ++i) {
    ASSERT_EQ(direct[i], t.direct[i]);
    ASSERT_NEAR(radiance[i].r, direct[i].r + indirect[i].r, 1e-6f);
    ASSERT_NEAR(radiance[i].r, (halfA[i].r + halfB[i].r) / 2, 1e-5f);
    error += glm::dvec3(variance[i]) / double(radiance.size() * radiance.size());
  }
  EXPECT_NEAR(meanOf(radiance).r, meanOf(t.radiance).r, 5 * std::sqrt(error.r));
  EXPECT_EQ(test.counter("paths"), 16 * 24 * 24);
  EXPECT_EQ(test.counter("samples"), 16);
  EXPECT_GT(test.counter("rays"), 16 * 24 * 24);
}

TEST(PathTracePass, EmptySceneIsTheEnvironment) {
  PassTest test("path-trace");
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  s.environment = {0.25f, 0.5f, 1};
  test.param("spp", 2).viewSize(4, 4).scene(s);
  test.run();
  for (const glm::vec4& v : test.values<glm::vec4>("radiance")) EXPECT_EQ(v, glm::vec4(0.25f, 0.5f, 1, 1));
}

// A board moves between the sun and the floor, and every frame has new noise.
TEST(PathTracePass, FollowsWhatMoves) {
  scene::Scene s = plane(glm::vec3(0.5f));
  s.lights = {sun({0, -1, 0}, glm::vec3(1))};
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 1, {-0.5f, 4, 0.5f}, {1, 0, 0}, {0, 0, -1});  // above the eye
  s.nodes[1].dynamic = true;
  scene::Mover mover;
  mover.node = 1;
  mover.smooth = false;
  mover.keys.resize(2);
  mover.keys[0].translation = {3, 0, 0};
  mover.keys[1].time = 1 / 42.0f;
  s.movers = {mover};
  PassTest test("path-trace");
  test.param("spp", 2).viewSize(33, 33).scene(s);
  test.run();
  const auto before = test.values<glm::vec4>("direct");
  test.run();
  const auto after = test.values<glm::vec4>("direct");
  const size_t centre = 33 * 16 + 16;
  EXPECT_NEAR(before[centre].r, 0.5 / kPi, 1e-5);
  EXPECT_EQ(after[centre].r, 0);
  // 1 m of the floor is 33 / (2 * 3 * tan 0.5) pixels.
  const auto dark = std::count_if(after.begin(), after.end(), [](const glm::vec4& v) { return v.r == 0; });
  EXPECT_NEAR(std::sqrt(double(dark)), 33 / (6 * std::tan(0.5)), 1);
}

TEST(PathTracePass, NoiseChangesWithTheFrameUnlessToldNotTo) {
  for (const bool perFrame : {true, false}) {
    PassTest test("path-trace");
    test.param("spp", 2).param("per_frame", perFrame).viewSize(16, 16).scene(scene::builtin("cornellbox"));
    test.run();
    const auto first = test.bytes("indirect");
    test.run();
    EXPECT_EQ(first == test.bytes("indirect"), !perFrame);
  }
}

TEST(PathTracePass, GraphHasTheLayersOfTheOthers) {
  GraphRunOptions options;
  options.size = {32, 32};
  options.set = {"spp=8"};
  const GraphRun run = runGraph("reference", scene::builtin("cornellbox"), options);
  for (const char* name : {"image", "radiance", "direct", "indirect", "variance", "half_a", "half_b"})
    EXPECT_EQ(run.outputs.count(name), 1u) << name;
}

}  // namespace
}  // namespace fovea::test
