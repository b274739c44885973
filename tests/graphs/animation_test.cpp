// Runs 60 frames at 42 Hz, almost a second and a half, of every built-in scene. The validation layers must stay
// silent, all values must be finite, and the picture may change little from frame to frame beyond what traced paths
// show, both on average and in any single frame, where popping would appear.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/scene.h"
#include "framework/image/metrics.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

constexpr uint32_t kFrames = 60;
constexpr uint64_t kFirst = 150;
constexpr double kRate = 42;  // Hz
constexpr uint32_t kSide = 48;

// Bounds of the excess of change, see blockExcess(), x 1e-3: the median and the maximum over all pairs of frames, and
// the maximum over the pairs in which the gaze jumps. They are a third above the most that a few seeds show: 1 to 3
// for `ours`, 1 to 5 for `foveal` in the room, and 1 and 2 in the other scenes. The traced light has so many paths that
// its own noise adds little. With a fifth of the VPLs and a 450th of the pixels, everything flickers
// more than in a picture of full size; and `ours`, as in the paper, replaces as many VPLs at once as the gaze asks for.
struct Case {
  const char* scene;
  const char* graph;
  double median, most, jump;
};
const Case kCase{"cornellbox_moving", "foveal", 0.02, 0.13, 0.075};
const Case kLongCases[] = {{"cornellbox_moving", "ours", 0.13, 2.7, 6},
                           {"atrium", "foveal", 0.085, 0.75, 0.23},
                           {"balcony", "foveal", 0.058, 0.2, 0.08},
                           {"room", "foveal", 0.12, 1.65, 0.29},
                           {"yard", "foveal", 0.058, 0.24, 0.08}};

scene::Frame frameOf(const scene::Scene& s, const scene::Geometry& geometry, uint64_t index) {
  return scene::makeFrame(s, geometry, {kSide, kSide}, kFirst + index, 1, kRate);
}

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
    frame = frameOf(s, *frame.geometry, frame.index);
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

// The picture that a graph shows in a frame and the traced one, which is also kept as two pictures of half of
// the paths each.
struct Shown {
  image::Picture graph, traced, halfA, halfB;
};

// Excess of change of a pair of frames over that of traced light (passes/paper.md, measures), computed on means over
// blocks: these average the noise of few paths away and keep what pops. What is left of that noise is subtracted.
double blockExcess(const Shown& now, const Shown& before) {
  constexpr uint32_t kBlock = 8, kBlocks = kSide / kBlock;
  struct Sums {
    double difference = 0, noiseNow = 0, noiseBefore = 0;
  };
  std::vector<Sums> sums(size_t(kBlocks) * kBlocks * 3);
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x)
      for (uint32_t c = 0; c < 3; ++c) {
        const auto at = [&](const image::Picture& p) { return double(p.display.at(x, y, c)); };
        Sums& s = sums[3 * (y / kBlock * kBlocks + x / kBlock) + c];
        s.difference += at(now.graph) - at(before.graph) - (at(now.traced) - at(before.traced));
        s.noiseNow += 0.5 * (at(now.halfA) - at(now.halfB));
        s.noiseBefore += 0.5 * (at(before.halfA) - at(before.halfB));
      }
  double squares = 0;
  for (const Sums& s : sums)
    squares += s.difference * s.difference - s.noiseNow * s.noiseNow - s.noiseBefore * s.noiseBefore;
  return squares / double(sums.size()) / std::pow(kBlock, 4);
}

// Whether the eye makes a saccade before frame i. It sees little during one (saccadic suppression), and the VPLs
// follow it as fast as their turnover lets them.
std::vector<bool> gazeJumps(const scene::Scene& s) {
  const scene::Geometry geometry = scene::flatten(s);
  std::vector<bool> jumps(kFrames, false);
  for (uint64_t i = 1; i < kFrames; ++i)
    jumps[i] = glm::distance(frameOf(s, geometry, i).views[0].gaze,
                             frameOf(s, geometry, i - 1).views[0].gaze) > 0.05f;
  return jumps;
}

class Animation : public testing::TestWithParam<Case> {};

TEST_P(Animation, FlickersNoMoreThanTracedLight) {
  Diagnostics warnings;
  const scene::Scene s = scene::load(GetParam().scene, warnings);
  const GraphRun run =
      render(GetParam().graph, s, {"shadow_map_size=1024", "map_size=32", "vpl_count=200", "voxels=64"},
             {"radiance"});
  const GraphRun truth = render("reference", s, {"spp=256"}, {"radiance", "half_a", "half_b"});
  ASSERT_EQ(run.frames.size(), kFrames);
  const std::vector<bool> jumps = gazeJumps(s);
  std::vector<double> steady;  // excess of each pair of frames
  double jump = 0;             // most of those in which the gaze jumps
  Shown before;
  for (uint32_t i = 0; i < kFrames; ++i) {
    for (const float v : toFloats(run.frames[i].outputs.at("radiance"))) ASSERT_TRUE(std::isfinite(v)) << i;
    const auto of = [&](const GraphRun& r, const char* output) {
      return picture(r.frames[i], output, s.exposure);
    };
    const Shown now{of(run, "radiance"), of(truth, "radiance"), of(truth, "half_a"), of(truth, "half_b")};
    if (i > 0 && jumps[i]) jump = std::max(jump, blockExcess(now, before));
    if (i > 0 && !jumps[i]) steady.push_back(blockExcess(now, before));
    before = now;
  }
  std::sort(steady.begin(), steady.end());
  const double median = steady[steady.size() / 2], most = steady.back();
  std::printf("excess x 1e-3: median %.3f, most %.3f, with the gaze %.3f\n", 1e3 * median, 1e3 * most,
              1e3 * jump);
  EXPECT_LT(1e3 * median, GetParam().median);
  EXPECT_LT(1e3 * most, GetParam().most) << "something pops";
  EXPECT_LT(1e3 * jump, GetParam().jump) << "something pops as the gaze jumps";
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  return std::string(info.param.scene) + "_" + info.param.graph;
}
INSTANTIATE_TEST_SUITE_P(Scenes, Animation, testing::Values(kCase), nameOf);
INSTANTIATE_TEST_SUITE_P(LongScenes, Animation, testing::ValuesIn(kLongCases), nameOf);

// Largest change of any mean over 8x8 pixels and of the mean over all pixels, of any channel, in displayed values
// from 0 to 1.
struct Change {
  double block = 0, mean = 0;
};
Change change(const image::Picture& now, const image::Picture& before) {
  constexpr uint32_t kBlock = 8;
  Change most;
  for (uint32_t c = 0; c < 3; ++c) {
    double all = 0;
    for (uint32_t y = 0; y < kSide; y += kBlock)
      for (uint32_t x = 0; x < kSide; x += kBlock) {
        double sum = 0;
        for (uint32_t i = 0; i < kBlock * kBlock; ++i)
          sum += double(now.display.at(x + i % kBlock, y + i / kBlock, c)) -
                 double(before.display.at(x + i % kBlock, y + i / kBlock, c));
        most.block = std::max(most.block, std::abs(sum) / (kBlock * kBlock));
        all += sum;
      }
    most.mean = std::max(most.mean, std::abs(all) / (kSide * kSide));
  }
  return most;
}

// A scene that stands still looks the same wherever the eye looks: when the gaze jumps, the light that `foveal`
// shows changes little from one frame to the next. The bounds are a third above what is measured. If all paths
// started anew at once, the mean would change by 0.026 and 0.019. VPLs that are removed vanish at once, so single
// blocks change by more.
struct Jump {
  const char* scene;
  double block, mean;
};

TEST(GazeJump, LightDoesNotJumpWithIt) {
  constexpr uint64_t kJump = 24;
  for (const Jump& bound : {Jump{"atrium", 0.023, 0.007}, Jump{"room", 0.059, 0.01}}) {
    Diagnostics warnings;
    const scene::Scene s = scene::load(bound.scene, warnings);
    GraphRunOptions options;
    options.size = {kSide, kSide};
    options.frames = kJump + 12;
    options.everyFrame = true;
    options.set = {"shadow_map_size=1024", "map_size=32", "vpl_count=200", "voxels=64"};
    options.outputs = {"radiance"};
    options.beforeFrame = [&](scene::Frame& frame) {
      scene::GpuScene* gpu = frame.gpu;
      const uint64_t index = frame.index;
      frame = scene::makeFrame(s, *frame.geometry, {kSide, kSide}, 36, options.seed, kRate);
      frame.gpu = gpu;
      frame.index = index;
      frame.views[0].gaze = index < kJump ? glm::vec2(0.5f, 0.5f) : glm::vec2(0.75f, 0.35f);
    };
    const GraphRun run = runGraph("foveal", s, options);
    Change most;
    for (uint32_t i = kJump; i < options.frames; ++i) {
      const Change c = change(picture(run.frames[i], "radiance", s.exposure),
                              picture(run.frames[i - 1], "radiance", s.exposure));
      most.block = std::max(most.block, c.block), most.mean = std::max(most.mean, c.mean);
    }
    std::printf("%s: blocks change by %.4f, the mean by %.4f\n", bound.scene, most.block, most.mean);
    EXPECT_LT(most.block, bound.block) << bound.scene;
    EXPECT_LT(most.mean, bound.mean) << bound.scene;
    EXPECT_GT(most.block, 0) << "the gaze moved nothing";
  }
}

// Four frames after a jump the new fovea is better with the share of work that a saccade adds than without it: in the
// mean over seeds, as that of one changes with every detail of the voxels.
TEST(GazeJump, TheNewFoveaIsSoonGood) {
  constexpr uint64_t kJump = 24;
  Diagnostics warnings;
  const scene::Scene s = scene::load("cornellbox", warnings);
  const glm::vec2 gazes[] = {{0.25f, 0.3f}, {0.7f, 0.65f}};
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.outputs = {"indirect"};
  options.everyFrame = true;
  options.set = {"spp=256"};
  const image::Picture truth =
      picture(runGraph("reference", s, options).frames.back(), "indirect", s.exposure);
  const auto errorOf = [&](std::vector<std::string> set, uint32_t seed) {
    options.seed = seed;
    set.insert(set.end(), {"shadow_map_size=512", "map_size=32", "vpl_count=200", "voxels=48"});
    options.frames = kJump + 5;
    options.set = std::move(set);
    options.beforeFrame = [&](scene::Frame& frame) {
      frame.views[0].gaze = gazes[frame.index >= kJump];
      frame.saccade = frame.index >= kJump ? 1 - float(frame.index - kJump) / scene::kSaccadeFrames : 0;
    };
    const image::Picture seen = picture(runGraph("foveal", s, options).frames.back(), "indirect", s.exposure);
    double sum = 0;
    int pixels = 0;
    for (uint32_t y = 0; y < kSide; ++y)
      for (uint32_t x = 0; x < kSide; ++x) {
        if (glm::distance(glm::vec2(x, y) + 0.5f, gazes[1] * float(kSide)) > 0.25f * kSide) continue;
        for (uint32_t c = 0; c < 3; ++c)
          sum += std::pow(seen.display.at(x, y, c) - truth.display.at(x, y, c), 2) / 3;
        ++pixels;
      }
    return sum / pixels;
  };
  double with = 0, without = 0;
  for (uint32_t seed = 1; seed <= 3; ++seed) {
    with += errorOf({}, seed) / 3;
    without += errorOf({"saccade_samples=1", "eye-paths.saccade_renew_frames=8"}, seed) / 3;
  }
  std::printf("error four frames after a jump: %.6f, without a saccade's share %.6f\n", with, without);
  EXPECT_LT(with, 0.9 * without);
}

}  // namespace
}  // namespace fovea::test
