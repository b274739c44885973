// Tests `foveal_view`, the graph for viewing: its edges approach a mean over the area of each pixel, nothing leaves a
// trail, and static surfaces do not flicker.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/passes/ray_reference.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr int kSide = 64, kFine = 4;

// A room without its front wall, with a turned pillar and a striped bar in it. With `speed`, a red box passes in front
// of the back wall, so many metres a second to the right.
scene::Scene pillars(float speed = 0) {
  scene::Scene s;
  s.materials.clear();
  uint32_t m[6];
  for (uint32_t& material : m) material = addMaterial(s, glm::vec3(0.6f));
  addRoom(s, m, 2);
  s.nodes.pop_back();  // +z is open
  const uint32_t white = addMaterial(s, glm::vec3(0.9f)), dark = addMaterial(s, glm::vec3(0.05f));
  addBox(s, dark, {-1.3f, -2, -0.5f}, {-0.9f, 1.5f, -0.1f});
  s.nodes.back().rotation = glm::angleAxis(0.1f, glm::vec3(0, 0, 1));
  addBox(s, white, {-0.6f, -2, -1}, {1.5f, -1.4f, 0});
  s.nodes.back().rotation = glm::angleAxis(0.13f, glm::vec3(0, 0, 1));
  if (speed > 0) {
    const uint32_t box = uint32_t(s.nodes.size());
    addBox(s, addMaterial(s, {0.7f, 0.05f, 0.02f}), {-0.3f, -0.3f, -0.05f}, {0.3f, 0.3f, 0.05f});
    s.nodes[box].dynamic = true;
    s.movers = {{box,
                 true,
                 scene::Repeat::Once,
                 {{0, {-0.5f, 0.9f, 0.5f}, glm::quat(1, 0, 0, 0), true},
                  {10, {-0.5f + 10 * speed, 0.9f, 0.5f}, glm::quat(1, 0, 0, 0), true}}}};
  }
  scene::Light lamp;
  lamp.type = scene::LightType::Point;
  lamp.position = {0.3f, 1.0f, 3.5f};
  lamp.intensity = 30;
  s.lights = {lamp};
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 0, 5};
  return s;
}

GraphRunOptions options(int side, uint32_t frames) {
  GraphRunOptions o;
  o.size = glm::uvec2(side);
  o.frames = frames;
  o.set = {"vpl_count=200", "attempts=1500", "voxels=32", "map_size=32"};
  o.outputs = {"image"};
  return o;
}

// `foveal_view` with the tone curve of every measure.
GraphRunOptions viewOptions(int side, uint32_t frames) {
  GraphRunOptions o = options(side, frames);
  o.set.push_back("tonemap.operator=clamp");
  return o;
}

double linear(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }
double srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

// Mean of each 4x4 pixels, as light. `range` gets the difference between the brightest and the darkest of them.
std::vector<float> shrunk(const std::vector<float>& fine, std::vector<float>& range) {
  std::vector<float> image;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (int c = 0; c < 4; ++c) {
        double sum = 0;
        float least = 1, most = 0;
        for (int i = 0; i < kFine * kFine; ++i) {
          const int fx = kFine * x + i % kFine, fy = kFine * y + i / kFine;
          const float v = fine[4 * size_t(fy * kFine * kSide + fx) + size_t(c)];
          sum += linear(v), least = std::min(least, v), most = std::max(most, v);
        }
        image.push_back(float(srgb(sum / (kFine * kFine))));
        range.push_back(most - least);
      }
  return image;
}

// Both graphs, with six seeds, against traced light over the area of each pixel: near edges, most of the error of
// `foveal` is gone, and elsewhere little is lost.
TEST(LongSmoothEdges, ApproachTheMeanOverThePixelsArea) {
  const scene::Scene s = pillars();
  GraphRunOptions traced = options(kFine * kSide, 1);
  traced.set = {"spp=64"};
  std::vector<float> range;
  const std::vector<float> reference =
      shrunk(toFloats(runGraph("reference", s, traced).outputs.at("image")), range);
  const auto isEdge = [&](size_t i) { return range[i] > 0.15f; };
  int count[2] = {};
  double error[2][2] = {};  // mean over the seeds
  for (size_t i = 0; i < reference.size(); ++i)
    if (i % 4 != 3) ++count[isEdge(i)];
  constexpr uint32_t kSeeds = 6;
  for (uint32_t seed = 1; seed <= kSeeds; ++seed)
    for (const bool view : {false, true}) {
      GraphRunOptions o = view ? viewOptions(kSide, 24) : options(kSide, 24);
      o.seed = seed;
      const std::vector<float> image =
          toFloats(runGraph(view ? "foveal_view" : "foveal", s, o).outputs.at("image"));
      for (size_t i = 0; i < reference.size(); ++i)
        if (i % 4 != 3)
          error[view][isEdge(i)] +=
              std::pow(double(image[i] - reference[i]), 2) / (kSeeds * count[isEdge(i)]);
    }
  ASSERT_GT(count[true], 300);
  for (const bool edge : {true, false})
    std::printf("MSE x 1000 %s: foveal %.3f, foveal_view %.3f (%d values)\n", edge ? "at edges" : "elsewhere",
                1000 * error[false][edge], 1000 * error[true][edge], count[edge]);
  EXPECT_LT(error[true][true], 0.1 * error[false][true]);
  EXPECT_LT(error[true][false], 1.2 * error[false][false]);
}

// Pictures of the passing box, and of the scene without it, frame by frame.
struct Passing {
  std::vector<std::vector<float>> with, without;
  // By how much the two differ at a pixel.
  double away(size_t frame, int x, int y) const {
    const size_t i = 4 * size_t(std::clamp(y, 0, kSide - 1) * kSide + std::clamp(x, 0, kSide - 1));
    double most = 0;
    for (size_t c = i; c < i + 3; ++c)
      most = std::max(most, std::abs(double(with[frame][c]) - double(without[frame][c])));
    return most;
  }
};

Passing passing(const char* graph, GraphRunOptions o) {
  Passing pictures;
  o.everyFrame = true;
  for (const bool box : {false, true})
    for (const graph::FrameResult& f : runGraph(graph, pillars(box ? 3.0f : 0), o).frames)
      (box ? pictures.with : pictures.without).push_back(toFloats(f.outputs.at("image")));
  return pictures;
}

// Two frames after a box and its shadow have left a pixel, it looks as if there had never been a box. One frame after,
// the edge of a shadow may still be there, since the colours around the pixel do not tell that the edge has moved.
TEST(SmoothEdges, NothingLeavesATrail) {
  constexpr uint32_t kFrames = 24;
  const Passing jagged = passing("foveal", options(kSide, kFrames)),
                smooth = passing("foveal_view", viewOptions(kSide, kFrames));
  int left = 0;
  double most = 0, sum[2] = {};
  for (size_t frame = 10; frame < kFrames; ++frame)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        bool before = false, now = false, edge = false;
        for (size_t f = frame - 6; f < frame - 1; ++f) before |= jagged.away(f, x, y) > 0.15;
        for (size_t f = frame - 1; f <= frame; ++f) now |= jagged.away(f, x, y) > 0.05;
        // At edges of the still picture the mean has begun anew, and differs from that of many frames.
        const size_t i = 4 * size_t(y * kSide + x);
        for (size_t c = i; c < i + 3; ++c)
          edge |= std::abs(smooth.without[frame][c] - jagged.without[frame][c]) > 0.02f;
        if (!before || now || edge) continue;
        ++left;
        sum[false] += jagged.away(frame, x, y), sum[true] += smooth.away(frame, x, y);
        most = std::max(most, smooth.away(frame, x, y) - jagged.away(frame, x, y));
      }
  ASSERT_GT(left, 500);
  std::printf("%d pixels left: mean difference x 255: foveal %.2f, foveal_view %.2f, at most %.1f more\n",
              left, 255 * sum[false] / left, 255 * sum[true] / left, 255 * most);
  EXPECT_LT(sum[true], sum[false] + 0.004 * left);
  EXPECT_LT(most, 0.04);
}

// In a still picture the jitter is hardly seen: from frame to frame no value changes by a tenth of its range, and on
// average they change far less.
TEST(SmoothEdges, StillPicturesDoNotFlicker) {
  constexpr uint32_t kFrames = 25;
  GraphRunOptions o = viewOptions(kSide, kFrames);
  o.everyFrame = true;
  const GraphRun run = runGraph("foveal_view", pillars(), o);
  std::vector<std::vector<float>> pictures;
  for (size_t f = kFrames - 9; f < kFrames; ++f)
    pictures.push_back(toFloats(run.frames[f].outputs.at("image")));
  double sum = 0, most = 0;
  for (size_t f = 1; f < pictures.size(); ++f)
    for (size_t i = 0; i < pictures[f].size(); ++i) {
      const double change = std::abs(double(pictures[f][i]) - double(pictures[f - 1][i]));
      sum += change * change, most = std::max(most, change);
    }
  std::printf("change from frame to frame x 255: rms %.2f, most %.1f\n",
              255 * std::sqrt(sum / double(8 * pictures[0].size())), 255 * most);
  EXPECT_LT(std::sqrt(sum / double(8 * pictures[0].size())), 0.004);
  EXPECT_LT(most, 0.1);
}

// The mean over the values of exposure * radiance / radiance of pixels that are neither dark nor clamped.
double exposureOf(const std::vector<float>& image, const std::vector<float>& radiance) {
  double shown = 0, light = 0;
  for (size_t i = 0; i < image.size(); ++i) {
    if (i % 4 == 3 || image[i] < 0.3f || image[i] > 0.95f) continue;
    shown += linear(image[i]), light += double(radiance[i]);
  }
  return shown / light;
}

// `foveal_stereo_view`: the left eye is that of `foveal_view`, the right one is as smooth, and both have one exposure.
TEST(SmoothEdges, OfBothEyes) {
  const scene::Scene s = pillars();
  GraphRunOptions o = viewOptions(kSide, 24);
  o.outputs = {"image", "radiance", "image_right", "radiance_right"};
  o.set.push_back("right/tonemap.operator=clamp");
  const GraphRun both = runGraph("foveal_stereo_view", s, o);
  const auto look = [](const char* view) {
    return [view](scene::Frame& frame) {
      frame.views[0] = *frame.findView(view);
      frame.views[0].name = "main";
    };
  };
  GraphRunOptions one = viewOptions(kSide, 24);
  one.beforeFrame = look("left");
  EXPECT_EQ(both.outputs.at("image").bytes, runGraph("foveal_view", s, one).outputs.at("image").bytes);

  double error[2] = {};
  for (const bool right : {false, true}) {
    GraphRunOptions traced = options(kFine * kSide, 1);
    traced.set = {"spp=16"};
    traced.beforeFrame = look(right ? "right" : "left");
    std::vector<float> range;
    const std::vector<float> exact = shrunk(toFloats(runGraph("reference", s, traced).outputs.at("image")),
                                            range),
                             image = toFloats(both.outputs.at(right ? "image_right" : "image"));
    int count = 0;
    for (size_t i = 0; i < exact.size(); ++i) {
      if (i % 4 == 3 || range[i] <= 0.15f) continue;
      ++count;
      error[right] += std::pow(double(image[i] - exact[i]), 2);
    }
    ASSERT_GT(count, 300);
    error[right] /= count;
  }
  std::printf("MSE x 1000 at edges: left %.3f, right %.3f\n", 1000 * error[0], 1000 * error[1]);
  EXPECT_LT(error[1], 1.25 * error[0]);
  const double left = exposureOf(toFloats(both.outputs.at("image")), toFloats(both.outputs.at("radiance"))),
               right = exposureOf(toFloats(both.outputs.at("image_right")),
                                  toFloats(both.outputs.at("radiance_right")));
  EXPECT_NEAR(right / left, 1, 0.01);
}

}  // namespace
}  // namespace fovea::test
