// A second and a half of every built-in scene, 60 frames at 42 Hz: no message of the validation layers,
// nothing that is not finite, and little change from frame to frame that traced paths do not show: neither on
// the whole (METHOD.md 4: MSE' and its excess) nor in any single frame, as something that pops would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "framework/image/metrics.h"
#include "framework/scene/load.h"
#include "tests/support/pass_test.h"

namespace fovea::test {
namespace {

constexpr uint32_t kFrames = 60;
constexpr uint64_t kFirst = 150;
constexpr double kRate = 42;  // Hz
constexpr uint32_t kSide = 48;

struct Case {
  const char* scene;
  const char* graph;
  double excess;  // most of it, x 1e-3; measured: see kCases
};
const Case kCases[] = {{"cornellbox_moving", "ours", 1},
                       {"cornellbox_moving", "foveal", 1},
                       {"atrium", "ours", 1},
                       {"atrium", "foveal", 1},
                       {"balcony", "ours", 1},
                       {"balcony", "foveal", 1},
                       {"room", "ours", 1},
                       {"room", "foveal", 1},
                       {"yard", "ours", 1},
                       {"yard", "foveal", 1}};

GraphRun render(const char* graph, const scene::Scene& s, std::vector<std::string> set,
                std::vector<std::string> outputs) {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = kFrames;
  options.everyFrame = true;
  options.set = std::move(set);
  options.outputs = std::move(outputs);
  options.beforeFrame = [&s](scene::Frame& frame) {
    scene::GpuScene* gpu = frame.gpu;
    frame = scene::makeFrame(s, *frame.geometry, {kSide, kSide}, kFirst + frame.index, 1, kRate);
    frame.gpu = gpu;
  };
  return runGraph(graph, s, options);
}

image::Picture picture(const graph::FrameResult& frame, const char* output, float exposure) {
  const std::vector<float> rgba = toFloats(frame.outputs.at(output));
  image::Image radiance{kSide, kSide, 3, std::vector<float>(size_t(kSide) * kSide * 3)};
  for (size_t i = 0; i < size_t(kSide) * kSide; ++i)
    for (size_t c = 0; c < 3; ++c) radiance.data[3 * i + c] = rgba[4 * i + c];
  return image::fromRadiance(radiance, exposure);
}

const GraphRun& traced(const std::string& name, const scene::Scene& s) {
  static std::map<std::string, GraphRun> runs;
  if (runs.count(name) == 0)
    runs.emplace(name, render("reference", s, {"spp=32"}, {"radiance", "half_a", "half_b"}));
  return runs.at(name);
}

// As the excess of one pair of frames, of means over blocks: the noise of few samples falls away, what pops
// does not.
double blockExcess(const image::Picture& now, const image::Picture& before, const image::Picture& traceNow,
                   const image::Picture& traceBefore) {
  constexpr uint32_t kBlock = 8, kBlocks = kSide / kBlock;
  std::vector<double> sums(size_t(kBlocks) * kBlocks * 3);
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x)
      for (uint32_t c = 0; c < 3; ++c)
        sums[3 * (y / kBlock * kBlocks + x / kBlock) + c] +=
            double(now.display.at(x, y, c)) - before.display.at(x, y, c) -
            (double(traceNow.display.at(x, y, c)) - traceBefore.display.at(x, y, c));
  double squares = 0;
  for (const double s : sums) squares += s * s;
  return squares / double(sums.size()) / std::pow(kBlock, 4);
}

class Animation : public testing::TestWithParam<Case> {};

TEST_P(Animation, FlickersNoMoreThanTracedLight) {
  Diagnostics warnings;
  const scene::Scene s = scene::load(GetParam().scene, warnings);
  const GraphRun run =
      render(GetParam().graph, s, {"shadow_map_size=512", "map_size=32", "vpl_count=200", "voxels=64"},
             {"radiance"});
  const GraphRun& truth = traced(GetParam().scene, s);
  ASSERT_EQ(run.frames.size(), kFrames);
  const image::Disc all{0.5f * kSide, 0.5f * kSide, kSide};
  image::SequenceComparison whole;
  std::vector<double> excess;  // of each pair of frames, of blocks
  image::Picture now, before, traceNow, traceBefore;
  for (uint32_t i = 0; i < kFrames; ++i) {
    for (const float v : toFloats(run.frames[i].outputs.at("radiance"))) ASSERT_TRUE(std::isfinite(v)) << i;
    const auto of = [&](const char* output) { return picture(truth.frames[i], output, s.exposure); };
    now = picture(run.frames[i], "radiance", s.exposure), traceNow = of("radiance");
    whole.add(now, traceNow, image::Halves{of("half_a"), of("half_b")}, all);
    if (i > 0) excess.push_back(blockExcess(now, before, traceNow, traceBefore));
    before = now, traceBefore = traceNow;
  }
  const image::SequenceMeasures m = whole.result().whole;
  std::vector<double> sorted = excess;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2], most = sorted.back();
  std::printf(
      "x 1e-3: MSE' %.3f, of traced paths %.3f, excess %.3f; of blocks of one frame: median %.3f, most "
      "%.3f\n",
      1e3 * m.change, 1e3 * m.referenceChange, 1e3 * m.excess, 1e3 * median, 1e3 * most);
  EXPECT_LT(1e3 * m.excess, GetParam().excess);
  EXPECT_LT(most, 4 * median + 1e-4) << "something pops";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Animation, testing::ValuesIn(kCases), [](const auto& info) {
  return std::string(info.param.scene) + "_" + info.param.graph;
});

}  // namespace
}  // namespace fovea::test
