// Tests probes from end to end: a furnace with a closed form, and the Cornell box against traced paths.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "fovea/scene.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr const char* kGraph = "alternatives/ddgi";

// Walls that emit {1, 2, 4} and reflect the share rho of what they get. Their indirect light is the same everywhere.
std::vector<float> furnace(const char* graph, float rho) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(rho)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = {1, 2, 4};
  addRoom(s, walls, 2);
  s.cameras.emplace_back();
  s.cameras[0].position = {0.3f, 0.2f, 1.5f};
  GraphRunOptions options;
  options.size = {32, 32};
  options.frames = 60;
  options.set = {"probes=4", "rays=32", "hysteresis=0.5"};
  return toFloats(runGraph(graph, s, options).outputs.at("indirect"));
}

// All walls are as bright as L / (1 - rho), of which L rho / (1 - rho) is indirect.
TEST(Ddgi, FurnaceIsEvenlyLitByAllItsBounces) {
  for (const float rho : {0.3f, 0.7f}) {
    const auto indirect = furnace(kGraph, rho);
    for (size_t i = 0; i < indirect.size(); ++i) {
      if (i % 4 == 3) continue;
      const double expected = std::exp2(double(i % 4)) * double(rho) / (1 - double(rho));
      ASSERT_NEAR(indirect[i], expected, 0.01 * expected) << "pixel " << i / 4 << ", reflectance " << rho;
    }
  }
}

// A path of depth 4 that ends on a wall has one to three reflections. The last of them is sampled by one point of a wall
// for each ray, which makes single pixels noisy.
TEST(Ddgi, TwoBouncesAreThoseOfAPathTracerOfDepth4) {
  for (const char* graph : {"alternatives/ddgi_two_bounces", "alternatives/ddgi_foveated"}) {
    const auto indirect = furnace(graph, 0.7f);
    double mean = 0;
    for (size_t i = 0; i < indirect.size(); i += 4) mean += indirect[i] / double(indirect.size() / 4);
    EXPECT_NEAR(mean, 0.7 + 0.7 * 0.7 + 0.7 * 0.7 * 0.7, 0.02) << graph;
  }
}

// The error against paths of many bounces falls as the probes stand closer together.
TEST(LongDdgi, ErrorFallsWithTheSpacing) {
  scene::Scene s = scene::builtin("cornellbox");
  s.cameras[0].position += glm::vec3(0.037f, 0.021f, 0);  // no pixel looks exactly at a seam of the room
  GraphRunOptions options;
  options.size = {48, 48};
  options.set = {"depth=32", "spp=1024"};
  const GraphRun traced = runGraph("reference", s, options);
  const auto want = toFloats(traced.outputs.at("indirect")), noise = toFloats(traced.outputs.at("variance"));
  double before = 1e9;
  for (const int probes : {3, 6, 12}) {
    options.frames = 24;
    options.set = {"probes=" + std::to_string(probes), "rays=64"};
    const auto got = toFloats(runGraph(kGraph, s, options).outputs.at("indirect"));
    double error = 0, sum = 0, wanted = 0;
    for (size_t i = 0; i < want.size(); ++i) {
      if (i % 4 == 3) continue;
      error += (std::pow(double(got[i]) - want[i], 2) - noise[i]) / std::pow(want[i] + 0.01, 2) /
               (0.75 * double(want.size()));
      sum += got[i];
      wanted += want[i];
    }
    std::printf("  %2d probes along the longest axis: relMSE %.5f, mean %.4f of the reference's\n", probes,
                error, sum / wanted);
    EXPECT_LT(error, 0.85 * before);
    EXPECT_NEAR(sum / wanted, 1, 0.03);
    before = error;
  }
  EXPECT_LT(before, 0.04);
}

// The same bits in every run, also after a camera cut, which starts anew.
TEST(Ddgi, Repeats) {
  const scene::Scene s = scene::builtin("cornellbox");
  GraphRunOptions options;
  options.size = {24, 24};
  options.frames = 5;
  options.set = {"probes=4", "rays=16"};
  const auto first = toFloats(runGraph(kGraph, s, options).outputs.at("radiance"));
  const auto second = toFloats(runGraph(kGraph, s, options).outputs.at("radiance"));
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof first[0]), 0);
  options.seed = 2;
  EXPECT_NE(toFloats(runGraph(kGraph, s, options).outputs.at("radiance")), first);
}

// After a cut nothing is left of what the probes knew: the lamp is out, and so is its light.
TEST(Ddgi, ACutForgets) {
  const scene::Scene s = scene::builtin("cornellbox");
  GraphRunOptions options;
  options.size = {24, 24};
  options.frames = 8;
  options.set = {"probes=4", "rays=16"};
  options.everyFrame = true;
  options.beforeFrame = [](scene::Frame& frame) {
    if (frame.index < 4) return;
    for (scene::Light& light : frame.lights) light.intensity = 0;
    frame.cameraCut = frame.index == 4;
  };
  const GraphRun run = runGraph(kGraph, s, options);
  const auto sum = [&](size_t frame) {
    double all = 0;
    for (const float x : toFloats(run.frames[frame].outputs.at("indirect"))) all += x;
    return all - 24 * 24;  // alpha
  };
  EXPECT_GT(sum(3), 1);
  EXPECT_LT(sum(4), 0.2 * sum(3));
}

}  // namespace
}  // namespace fovea::test
