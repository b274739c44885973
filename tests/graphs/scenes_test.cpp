// Runs the built-in scenes over their whole animation: every method renders them without validation messages, deforming
// objects are seen to move, VPLs stay on moving objects, and the light of `ours` is about that of traced paths.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "fovea/scene.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "places.h"
#include "shaders/records/vpl.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

using scene::VplState;

constexpr double kSeconds = 8;    // of every scene's animation
constexpr double kRate = 42;      // Hz
constexpr uint32_t kLooks = 5;    // spread over the whole of it
constexpr uint32_t kInARow = 3;   // consecutive frames ...
constexpr uint32_t kFirst = 150;  // ... starting with this one

struct Animated {
  const char* name;
  // Mean indirect light of `ours` divided by that of traced paths, with 300 VPLs in voxels twice as wide as by default.
  // Measured: 1.008, 0.987, 1.138, 0.747, 1.253; single frames are within 0.13 of these.
  double low, high;
};
const Animated kScenes[] = {{"cornellbox_moving", 0.93, 1.08},
                            {"atrium", 0.91, 1.06},
                            {"balcony", 1.06, 1.21},
                            {"room", 0.67, 0.82},
                            {"yard", 1.18, 1.33}};

const scene::Scene& sceneOf(const std::string& name) {
  static std::map<std::string, scene::Scene> scenes;
  if (scenes.count(name) == 0) {
    Diagnostics warnings;
    scenes.emplace(name, scene::load(name, warnings));
  }
  return scenes.at(name);
}

// Frames `first`, first + 1, ... at the given number per second.
GraphRunOptions over(const scene::Scene& s, uint32_t frames, uint64_t first, double rate) {
  GraphRunOptions options;
  options.size = {64, 64};
  options.frames = frames;
  options.everyFrame = true;
  options.beforeFrame = [&s, first, rate, size = options.size](scene::Frame& frame) {
    scene::GpuScene* gpu = frame.gpu;
    frame = scene::makeFrame(s, *frame.geometry, size, first + frame.index, 1, rate);
    frame.gpu = gpu;
  };
  return options;
}

GraphRunOptions wholeAnimation(const scene::Scene& s) { return over(s, kLooks, 0, (kLooks - 1) / kSeconds); }
GraphRunOptions consecutive(const scene::Scene& s) { return over(s, kInARow, kFirst, kRate); }

// Small sizes and counts, for tests in which only the structure of the graph matters.
std::vector<std::string> smallSettings(const std::string& graph) {
  std::vector<std::string> set = {"shadow_map_size=256"};
  if (graph == "direct") return set;
  set.push_back("map_size=32");
  if (graph == "ir_1000") {
    set.push_back("vpl_count=16");  // all of their maps are new in every frame
    return set;
  }
  set.insert(set.end(), {"vpl_count=24", "voxels=64", "attempts=128"});
  return set;
}

double mean(const std::vector<float>& rgba) {
  double sum = 0;
  for (size_t i = 0; i < rgba.size(); i += 4) sum += (rgba[i] + rgba[i + 1] + rgba[i + 2]) / 3;
  return 4 * sum / double(rgba.size());
}

// Pictures must be finite, nowhere negative, not black, and different every time.
void expectPictures(const GraphRun& run, const std::string& output) {
  std::vector<float> before;
  for (const graph::FrameResult& frame : run.frames) {
    SCOPED_TRACE("frame " + std::to_string(frame.frame));
    for (const auto& [name, data] : frame.outputs)
      for (const float v : toFloats(data)) ASSERT_TRUE(std::isfinite(v) && v >= 0) << name;
    std::vector<float> now = toFloats(frame.outputs.at(output));
    EXPECT_GT(mean(now), 1e-3) << output;
    EXPECT_FALSE(now == before) << output;
    before = std::move(now);
  }
}

class Methods : public testing::TestWithParam<std::tuple<Animated, const char*>> {};

TEST_P(Methods, MakePicturesOverTheWholeAnimation) {
  const auto& [animated, graph] = GetParam();
  const scene::Scene& s = sceneOf(animated.name);
  for (GraphRunOptions options : {wholeAnimation(s), consecutive(s)}) {
    options.set = smallSettings(graph);
    const GraphRun run = runGraph(graph, s, options);
    ASSERT_EQ(run.frames.size(), options.frames);
    expectPictures(run, "radiance");
    if (std::string(graph) != "direct") expectPictures(run, "indirect");
    if (std::string(graph) == "stereo") expectPictures(run, "indirect_right");
  }
}

std::string nameOf(const testing::TestParamInfo<Methods::ParamType>& info) {
  return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param);
}
INSTANTIATE_TEST_SUITE_P(Scenes, Methods,
                         testing::Combine(testing::ValuesIn(kScenes), testing::Values("direct", "ours")),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(LongScenes, Methods,
                         testing::Combine(testing::ValuesIn(kScenes), testing::Values("ir_1000", "stereo")),
                         nameOf);

class ScenesInMotion : public testing::TestWithParam<Animated> {
 protected:
  const scene::Scene& scene() const { return sceneOf(GetParam().name); }
};

// Vertices move by centimetres over the animation, but only a little from one frame to the next.
TEST_P(ScenesInMotion, SomethingDeforms) {
  const scene::Scene& s = scene();
  scene::Geometry g = scene::flatten(s);
  const std::vector<glm::vec3> rest = g.positions;
  std::vector<float> furthest(g.objects.size(), 0.0f);
  float jump = 0;
  std::vector<glm::vec3> before;
  for (uint32_t look = 0; look < 2 * kLooks; ++look) {
    const uint64_t index = uint64_t(kSeconds * kRate / (kLooks * 2)) * (look / 2 * 2) + look % 2;
    scene::moveObjects(scene::makeFrame(s, g, {64, 64}, index, 1, kRate), g);
    for (size_t o = 1; o < g.objects.size(); ++o) {
      const scene::Object& object = g.objects[o];
      if (!object.deforms) continue;
      for (uint32_t v = object.firstVertex; v < object.firstVertex + object.vertexCount; ++v) {
        ASSERT_TRUE(glm::all(glm::lessThanEqual(g.positions[v], g.boundsMax)));
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(g.positions[v], g.boundsMin)));
        furthest[o] = std::max(furthest[o], glm::distance(g.positions[v], rest[v]));
        if (look % 2 == 1) jump = std::max(jump, glm::distance(g.positions[v], before[v]));
      }
    }
    before = g.positions;
  }
  int deforming = 0;
  for (size_t o = 1; o < g.objects.size(); ++o) {
    if (!g.objects[o].deforms) continue;
    ++deforming;
    EXPECT_GT(furthest[o], 0.03f) << g.objects[o].name;
  }
  EXPECT_GE(deforming, 1);
  EXPECT_GT(jump, 1e-4f);
  EXPECT_LT(jump, 0.1f) << "4 m/s";
}

// Uses the disc kernel, because a clamp of 1.5 m loses light in small rooms by design, and VPLs of the fovea alone,
// whose importance does not depend on their brightness.
TEST_P(ScenesInMotion, LightIsThatOfTracedPaths) {
  GraphRunOptions options = wholeAnimation(scene());
  options.outputs = {"indirect"};
  options.set = {"spp=16"};
  const GraphRun traced = runGraph("reference", scene(), options);
  options.set = smallSettings("ours");
  options.set.insert(options.set.end(), {"vpl_count=300", "attempts=1200"});
  const GraphRun ours = runGraph("ours", scene(), options);
  double sums[2] = {0, 0};
  for (uint32_t i = 0; i < kLooks; ++i) {
    const double want = mean(toFloats(traced.frames[i].outputs.at("indirect"))),
                 got = mean(toFloats(ours.frames[i].outputs.at("indirect")));
    std::printf("%.2f ", got / want);
    sums[0] += want, sums[1] += got;
  }
  std::printf(" indirect light of `ours` / traced, all frames: %.3f\n", sums[1] / sums[0]);
  EXPECT_GT(sums[1] / sums[0], GetParam().low);
  EXPECT_LT(sums[1] / sums[0], GetParam().high);
}

// `ours` without pictures: only the state that it keeps of its VPLs is wanted.
std::string graphWithState() {
  const auto file = std::filesystem::path(testing::TempDir()) / "scenes_state.json";
  std::ofstream(file) << R"({"extends": ")" FOVEA_SOURCE_DIR R"(/graphs/ours.json", "outputs": {
    "image": null, "radiance": null, "direct": null, "indirect": null, "state": "manage"}})";
  return file.string();
}

// A VPL that stays on the list keeps its place in the box or in the triangle of a cloth.
TEST_P(ScenesInMotion, VplsFollow) {
  const scene::Scene& s = scene();
  scene::Geometry g = scene::flatten(s);
  GraphRunOptions options = over(s, 10, kFirst, kRate);
  options.outputs = {"state"};
  options.set = {"shadow_map_size=512", "vpl_count=300", "voxels=64", "attempts=2000", "region=image"};
  const GraphRun run = runGraph(graphWithState(), s, options);
  std::vector<VplState> before;
  size_t kept = 0, onMovers = 0;
  for (uint32_t f = 0; f < run.frames.size(); ++f) {
    const scene::Frame frame = scene::makeFrame(s, g, {64, 64}, kFirst + f, 1, kRate);
    scene::moveObjects(frame, g);
    const auto& bytes = run.frames[f].outputs.at("state").bytes;
    std::vector<VplState> now(bytes.size() / sizeof(VplState));
    std::memcpy(now.data(), bytes.data(), bytes.size());
    for (size_t i = 0; i < now.size(); ++i) {
      const VplState& v = now[i];
      if (v.life == 0 || v.object == 0) continue;
      ++onMovers;
      const size_t object = size_t(v.object);
      if (g.objects[object].deforms) {
        const scene::Triangle& t = g.triangle(g.light().firstMoving + uint32_t(v.localPosition.x));
        ASSERT_EQ(t.object(), object) << f << " " << i;
        const glm::vec3 a = g.positions[t.v[0]],
                        n = glm::cross(g.positions[t.v[1]] - a, g.positions[t.v[2]] - a);
        ASSERT_LT(std::abs(glm::dot(v.position - a, glm::normalize(n))), 1e-4) << f << " " << i;
      } else {
        ASSERT_LT(glm::distance(frame.objects[object].intoObject(v.position), v.localPosition),
                  1e-4f * std::max(1.0f, glm::length(v.localPosition)))
            << f << " " << i;
      }
      if (before.empty() || v.life != before[i].life + 1 || before[i].object != v.object) continue;
      ++kept;
      ASSERT_EQ(v.localPosition, before[i].localPosition) << f << " " << i;
    }
    before = std::move(now);
  }
  std::printf("VPLs on movers: %.1f a frame, %.0f%% of them kept\n",
              double(onMovers) / double(run.frames.size()),
              100.0 * double(kept) / double(std::max<size_t>(onMovers, 1)));
  EXPECT_GT(onMovers, 0u);
  EXPECT_GT(kept, onMovers / 3);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScenesInMotion, testing::ValuesIn(kScenes),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace fovea::test
