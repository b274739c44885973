// Tests the endurance of whole graphs: camera cuts, jumps of the gaze, changes of size and edits of the graph in random
// order leave memory, pictures and times unchanged. It runs on request only, for FOVEA_SOAK_FRAMES frames of each
// graph, and looks at the memory of the process only with FOVEA_TEST_VALIDATION=off: the validation layers remember 13
// KB of each frame and 0.3 MB of each graph.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "framework/base/paths.h"
#include "framework/scene/load.h"
#include "framework/session/graph_run.h"
#include "framework/session/test_device.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

uint64_t residentBytes() {
  malloc_trim(0);
  uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * uint64_t(sysconf(_SC_PAGESIZE));
}

// One graph over a scene that moves, of which each stage has the same sizes and edits.
class Endured {
 public:
  explicit Endured(const char* graph)
      : graph_(graph),
        scene_(scene::load("cornellbox_moving", messages_)),
        geometry_(scene::flatten(scene_)) {}

  // Replaces the graph that runs, with what can be taken over of it.
  void run(uint32_t size, uint32_t edit) {
    graph::LoadOptions options;
    options.searchPaths = dataFolders("graphs");
    for (const std::string& text :
         {std::string("vpl_count=48"), std::string("map_size=16"), std::string("shadow_map_size=64"),
          std::string("voxels=48"), "tonemap.exposure=" + std::to_string(1 + edit)})
      options.overrides.push_back(graph::parseOverride(text));
    session::GraphRun::Options chosen;
    chosen.size = {size, size};
    chosen.readback = [](const graph::BoundGraph&) { return std::vector<std::string>{"radiance"}; };
    auto next = std::make_unique<session::GraphRun>(testDevice(), graph::load(graph_, options, messages_),
                                                    scene_, geometry_, chosen, messages_);
    next->prepare(run_.get());
    run_ = std::move(next);
  }

  // The time of the frame in ms. Broken pixels of the picture fail the test.
  double frame(bool cut, bool jump) {
    if (cut) index_ += 100 + random_() % 200;
    scene::Moment moment = scene::momentAt(scene_, index_++, 42);
    moment.cameraCut = moment.cameraCut || cut;
    if (jump) gaze_ = {float(random_() % 100) / 99, float(random_() % 100) / 99};
    moment.gazes.fill(gaze_);
    moment.saccade = jump ? 1 : 0;
    run_->submit(run_->frame(moment), true);
    const graph::FrameResult result = run_->executor().next().value();
    const std::vector<float> radiance = toFloats(result.outputs.at("radiance"));
    if (!std::all_of(radiance.begin(), radiance.end(), [](float v) { return std::isfinite(v); }))
      ADD_FAILURE() << graph_ << ": the picture of frame " << result.frame << " is not finite";
    return result.gpuMs + result.cpuMs;
  }

  uint32_t roll(uint32_t sides) { return random_() % sides; }

 private:
  const char* graph_;
  Diagnostics messages_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  std::unique_ptr<session::GraphRun> run_;
  std::mt19937 random_{1};
  uint64_t index_ = 0;
  glm::vec2 gaze_{0.5f};
};

class Soak : public testing::TestWithParam<const char*> {};

TEST_P(Soak, LeavesEverythingAsItWas) {
  constexpr uint32_t kStages = 10, kSizes[] = {40, 32, 64};
  const char* wanted = std::getenv("FOVEA_SOAK_FRAMES");
  if (!wanted) GTEST_SKIP() << "takes long; set FOVEA_SOAK_FRAMES to the number of frames, such as 10000";
  const uint32_t each = std::max(uint32_t(std::atoi(wanted)) / kStages, 6u);
  const uint64_t before = testDevice().allocatedBytes();
  {
    Endured endured(GetParam());
    std::array<uint64_t, kStages> resident{}, onDevice{};
    std::array<double, kStages> ms{};
    for (uint32_t stage = 0; stage < kStages; ++stage) {
      uint32_t size = kSizes[0];
      endured.run(size, 0);
      for (uint32_t i = 0; i < each; ++i) {
        // Each stage has at least one of each.
        const bool resize = i == 1 || endured.roll(50) == 0, edit = i == 3 || endured.roll(50) == 0;
        if (resize) size = kSizes[endured.roll(std::size(kSizes))];
        if (resize || edit) endured.run(size, endured.roll(5));
        endured.frame(i == 2 || endured.roll(50) == 0, i == 4 || endured.roll(20) == 0);
      }
      endured.run(kSizes[0], 0);
      std::vector<double> times;  // of frames that have the same to do in every stage
      for (int i = 0; i < 15; ++i) times.push_back(endured.frame(false, false));
      std::sort(times.begin(), times.end());
      resident[stage] = residentBytes(), onDevice[stage] = testDevice().allocatedBytes();
      ms[stage] = times[times.size() / 2];
      std::printf("%s, frame %u: %.1f MiB resident, %.1f MiB on the device, %.2f ms a frame\n", GetParam(),
                  (stage + 1) * each, double(resident[stage]) / (1 << 20),
                  double(onDevice[stage]) / (1 << 20), ms[stage]);
      std::fflush(stdout);
    }
    // The first stages warm the caches of driver and allocator.
    constexpr uint32_t kWarm = 2;
    constexpr uint64_t kAllocator = 4 << 20;  // more or less, by how its blocks fit
    for (uint32_t stage = kWarm + 1; stage < kStages; ++stage)
      EXPECT_EQ(onDevice[stage], onDevice[kWarm]) << stage;
    if (!FOVEA_SANITIZED && testDeviceOptions().validation == gpu::Validation::Off) {
      EXPECT_LE(resident[kStages - 1], uint64_t(1.02 * double(resident[kWarm])) + kAllocator);
    }
    // The machine may be busy with something else, so that only much slower frames say something.
    EXPECT_LT(ms[kStages - 1], 2 * ms[kWarm]);
  }
  EXPECT_EQ(testDevice().allocatedBytes(), before);
}
INSTANTIATE_TEST_SUITE_P(Graphs, Soak, testing::Values("ours", "foveal", "stereo"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace fovea::test
