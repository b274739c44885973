// Tests ReSTIR GI from end to end: its mean is the light of traced paths if it is unbiased; a furnace; the size of the
// bias; and repeatability.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "fovea/scene.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "tests/graphs/lit_sphere.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSide = 48, kParts = 3;
const char* const kGraph = "alternatives/restir_gi";

using Image = std::vector<float>;  // RGBA

// The camera is off the axis, where pixel centres would fall exactly on the seams of the room: there the G-buffer and the
// reference may show different walls.
scene::Scene offAxisCornellBox() {
  scene::Scene s = scene::builtin("cornellbox");
  s.cameras[0].position += glm::vec3(0.037f, 0.021f, 0);
  return s;
}

// Means of the whole picture, and of kParts x kParts parts of it.
struct Means {
  double all = 0;
  std::array<double, kParts * kParts> parts{};
};

Means meansOf(const Image& image) {
  Means m;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const double light = (double(image[4 * i]) + image[4 * i + 1] + image[4 * i + 2]) / 3;
    m.all += light / (kSide * kSide);
    m.parts[i / kSide * kParts / kSide * kParts + i % kSide * kParts / kSide] +=
        light * kParts * kParts / (kSide * kSide);
  }
  return m;
}

Image referenceOf(const scene::Scene& s) {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.set = {"spp=4096"};
  return toFloats(runGraph("reference", s, options).outputs.at("indirect"));
}

// Mean of many frames after the first ones, which know little of each other yet.
Image meanOf(const scene::Scene& s, uint32_t seed, std::vector<std::string> set) {
  constexpr uint32_t kFirst = 8, kFrames = 120;
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = kFirst + kFrames;
  options.seed = seed;
  options.everyFrame = true;
  options.outputs = {"indirect"};
  options.set = std::move(set);
  options.set.insert(options.set.end(), {"history_frames=1", "shadow_map_size=256"});
  const GraphRun run = runGraph(kGraph, s, options);
  Image mean(size_t(kSide) * kSide * 4);
  for (uint32_t f = kFirst; f < kFirst + kFrames; ++f) {
    const Image frame = toFloats(run.frames[f].outputs.at("indirect"));
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += frame[i] / float(kFrames);
  }
  return mean;
}

struct Compared {
  double ratio = 0, error = 0;  // of the mean over seeds, and its standard error
  double worstPart = 0;         // largest deviation of a part of the picture
  double relMse = 0;            // of the mean of all pictures
};

Compared compare(const scene::Scene& s, const Image& reference, uint32_t seeds,
                 const std::vector<std::string>& set) {
  const Means wanted = meansOf(reference);
  std::vector<double> ratios;
  Means sum;
  Image all(reference.size());
  for (uint32_t seed = 1; seed <= seeds; ++seed) {
    const Image mean = meanOf(s, seed, set);
    const Means m = meansOf(mean);
    ratios.push_back(m.all / wanted.all);
    for (size_t i = 0; i < m.parts.size(); ++i) sum.parts[i] += m.parts[i] / seeds;
    for (size_t i = 0; i < all.size(); ++i) all[i] += mean[i] / float(seeds);
  }
  Compared c;
  for (const double r : ratios) c.ratio += r / seeds;
  for (const double r : ratios) c.error += std::pow(r - c.ratio, 2) / (seeds * (seeds - 1));
  c.error = std::sqrt(c.error);
  for (size_t i = 0; i < sum.parts.size(); ++i)
    c.worstPart = std::max(c.worstPart, std::abs(sum.parts[i] / wanted.parts[i] - 1));
  for (size_t i = 0; i < all.size(); ++i)
    if (i % 4 != 3)
      c.relMse += std::pow((all[i] - reference[i]) / (reference[i] + 0.01), 2) / (3.0 * kSide * kSide);
  return c;
}

// A hedge of masked leaves over a floor in the sun. It sways by 3 cm within a quarter of a second.
scene::Scene swayingHedge() {
  scene::Scene s;
  addQuad(s, addMaterial(s, {0.6f, 0.5f, 0.4f}), {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  scene::Texture alpha{"leaf", 16, 16, true, {}};
  for (int i = 0; i < 256; ++i) {
    const float x = (float(i % 16) - 7.5f) / 8, y = (float(i / 16) - 7.5f) / 8;
    alpha.rgba.insert(alpha.rgba.end(), {255, 255, 255, uint8_t(x * x + y * y < 0.8f ? 255 : 0)});
  }
  s.textures = {alpha};
  const uint32_t leaf = addMaterial(s, {0.3f, 0.5f, 0.2f});
  s.materials[leaf].masked = s.materials[leaf].doubleSided = true;
  s.materials[leaf].baseColorTexture = {.texture = 0};
  const auto random = [](uint32_t i, uint32_t k) { return uniformFloat(hashCombine(i, k)); };
  for (uint32_t i = 0; i < 600; ++i) {
    const glm::vec3 at(3 * random(i, 0) - 1.5f, 1.2f * random(i, 1), 1.2f * random(i, 2) - 0.6f);
    const glm::vec3 u = glm::normalize(glm::vec3(random(i, 3), random(i, 4), random(i, 5)) - 0.5f),
                    v = glm::normalize(
                        glm::cross(u, glm::vec3(random(i, 6), random(i, 7), random(i, 8)) - 0.5f));
    addQuad(s, leaf, at, 0.22f * u, 0.22f * v);
  }
  for (size_t i = 2; i < s.meshes.size(); ++i) s.meshes[1].primitives.push_back(s.meshes[i].primitives[0]);
  s.meshes.resize(2);
  s.nodes.resize(2);
  s.nodes[1].dynamic = true;
  scene::Mover sways{.node = 1, .repeat = scene::Repeat::Loop, .keys = {}};
  for (const float side : {0, 1, 0, -1, 0})
    sways.keys.push_back({.time = 0.25f * float(sways.keys.size()), .translation = {0.03f * side, 0, 0}});
  s.movers = {sways};
  s.lights = {sun({0.4f, -1, -0.6f}, glm::vec3(3))};
  s.cameras.emplace_back();
  s.cameras[0].position = {0.05f, 0.7f, 3};
  s.cameras[0].verticalFov = 0.7f;
  return s;
}

// Samples move along with the leaves on which they lie. If they stayed where they were found, a fifth of the light would be
// lost behind the leaves.
TEST(RestirGi, NoLightIsLostInSwayingLeaves) {
  const scene::Scene s = swayingHedge();
  const Compared c = compare(s, referenceOf(s), 1, {});
  std::printf("  %.4f of the light; parts within %.3f\n", c.ratio, c.worstPart);
  EXPECT_NEAR(c.ratio, 1, 0.03);
  EXPECT_LT(c.worstPart, 0.07);
}

TEST(LongRestirGi, MeanIsTheLightOfTracedPathsUnlessBiased) {
  const scene::Scene s = offAxisCornellBox();
  const Image reference = referenceOf(s);
  const auto measured = [&](const char* name, uint32_t seeds, const std::vector<std::string>& set) {
    const Compared c = compare(s, reference, seeds, set);
    std::printf("  %s: %.4f of the light, standard error %.4f; parts within %.3f; relMSE of the mean %.5f\n",
                name, c.ratio, c.error, c.worstPart, c.relMse);
    return c;
  };
  const Compared unbiased = measured("unbiased", 4, {});
  EXPECT_NEAR(unbiased.ratio, 1, 0.01);
  EXPECT_LT(unbiased.error, 0.003);
  EXPECT_LT(unbiased.worstPart, 0.03);
  // These are noisier.
  for (const char* set : {"permutation=true", "spacing=2", "gi-samples.outside_spacing=2"}) {
    const Compared c = measured(set, 4, {set});
    EXPECT_NEAR(c.ratio, 1, 0.025);
    EXPECT_LT(c.worstPart, 0.06);
  }
  const Compared biased = measured("biased", 4, {"unbiased=false"});
  EXPECT_GT(biased.relMse, 1.5 * unbiased.relMse);
}

TEST(RestirGi, FurnaceIsEvenlyLit) {
  constexpr float kRho = 0.9f;
  const scene::Scene s = litSphere(kRho);
  for (const int depth : {3, 4, 6}) {
    const double expected = litSphereRadiance(kRho, depth - 2);
    const Means means = meansOf(meanOf(s, 1, {"depth=" + std::to_string(depth)}));
    std::printf("  depth %d: %.4f of the light\n", depth, means.all / expected);
    EXPECT_NEAR(means.all / expected, 1, 0.01) << depth;
    for (const double part : means.parts) EXPECT_NEAR(part / expected, 1, 0.02) << depth;
  }
}

// What is visible of an object that moves sees what it saw before, although rays from where it was would now start inside
// it. Its light follows a moving lamp with a delay.
TEST(RestirGi, MovingThingsKeepTheirLight) {
  constexpr uint64_t kLast = 24;
  Diagnostics messages;
  const scene::Scene s = scene::load("cornellbox_moving", messages);
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.set = {"spp=1024"};
  options.beforeFrame = [&s](scene::Frame& frame) {
    scene::GpuScene* gpu = frame.gpu;
    frame = scene::makeFrame(s, *frame.geometry, {kSide, kSide}, kLast, 1);
    frame.gpu = gpu;
  };
  const Means wanted = meansOf(toFloats(runGraph("reference", s, options).outputs.at("indirect")));
  options.beforeFrame = {};
  options.frames = kLast + 1;
  options.set = {"shadow_map_size=256"};
  const Means means = meansOf(toFloats(runGraph(kGraph, s, options).outputs.at("indirect")));
  std::printf("  %.4f of the light\n", means.all / wanted.all);
  EXPECT_NEAR(means.all / wanted.all, 1, 0.05);
}

TEST(RestirGi, RepeatsBitForBitWhileThingsMove) {
  Diagnostics messages;
  const scene::Scene s = scene::load("cornellbox_moving", messages);
  GraphRunOptions options;
  options.size = {41, 33};
  options.frames = 6;
  options.set = {"permutation=true", "view.materials=full", "shadow_map_size=256"};
  const GraphRun a = runGraph(kGraph, s, options), b = runGraph(kGraph, s, options);
  EXPECT_EQ(a.outputs.at("radiance").bytes, b.outputs.at("radiance").bytes);
  for (const float v : toFloats(a.outputs.at("radiance"))) ASSERT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace fovea::test
