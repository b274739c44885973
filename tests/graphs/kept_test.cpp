// What is kept from frame to frame while only some things move must equal, to the bit, what would be computed anew.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

#include "fovea/test.h"
#include "framework/scene/frame.h"
#include "framework/scene/motion/movers.h"
#include "framework/scene/scene.h"
#include "places.h"
#include "tests/passes/ray_reference.h"
#include "tests/references/voxel_grid.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

// A floor, a wall, a box that slides and turns, and a sun, a lamp and a bulb that do not move.
scene::Scene movingScene() {
  scene::Scene s;
  s.name = "moving";
  s.materials.resize(2);
  s.materials[1].baseColor = {0.8f, 0.6f, 0.1f, 1};
  addQuad(s, 0, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3});
  addQuad(s, 0, {-3, 0, -3}, {3, 0, -3}, {3, 4, -3}, {-3, 4, -3});
  scene::Node root;
  root.dynamic = true;
  s.nodes.push_back(root);
  addBox(s, 1, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
  for (size_t i = 3; i < s.nodes.size(); ++i) s.nodes[i].parent = 2;
  const glm::quat turned = glm::angleAxis(glm::radians(70.0f), glm::vec3(0, 1, 0));
  s.movers = {
      {2,
       true,
       scene::Repeat::Once,
       {{0, {-1.5f, 0.2f, 0}}, {6.0f / 42, {1, 0.5f, 0.5f}, turned, false}, {7.0f / 42, {1.5f, 0.3f, -1}}}}};
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 1.5f, 7};
  scene::Light sun, lamp, bulb;
  sun.direction = glm::normalize(glm::vec3(0.3f, -1, -0.4f));
  lamp.type = scene::LightType::Spot;
  lamp.position = {0, 4, 1};
  lamp.direction = {0, -1, 0};
  lamp.intensity = 50;
  bulb.type = scene::LightType::Point;
  bulb.position = {0.4f, 2.5f, 0.7f};
  bulb.intensity = 20;
  s.lights = {sun, lamp, bulb};
  return s;
}

constexpr uint32_t kFrames = 10;

// A box that is one moving object. The times of the keys are in frames.
void addMover(scene::Scene& s, float half, std::vector<scene::MotionKey> keys) {
  const size_t node = s.nodes.size(), mesh = s.meshes.size();
  addBox(s, 1, glm::vec3(-half), glm::vec3(half));
  for (size_t i = mesh + 1; i < s.meshes.size(); ++i)
    s.meshes[mesh].primitives.push_back(s.meshes[i].primitives[0]);
  s.meshes.resize(mesh + 1);
  s.nodes.resize(node + 1);
  s.nodes[node].dynamic = true;
  for (scene::MotionKey& key : keys) key.time /= 42;
  s.movers.push_back({uint32_t(node), true, scene::Repeat::Once, std::move(keys)});
}

// More moving things than can have boxes of their own. One slides, and one disappears and comes back elsewhere. Of
// those that share a box, one waits and then rises, one turns, and one appears late.
scene::Scene crowdedScene() {
  scene::Scene s = movingScene();
  s.movers.clear();
  s.nodes.resize(2);
  s.meshes.resize(2);
  const glm::quat none(1, 0, 0, 0), turned = glm::angleAxis(glm::radians(80.0f), glm::vec3(1, 1, 0));
  addMover(s, 0.3f, {{0, {-2, 0.4f, 1}}, {9, {-0.5f, 0.5f, 1.5f}}});
  addMover(s, 0.25f, {{0, {1.5f, 0.5f, 1}}, {3, {1.5f, 0.5f, 1}, none, false}, {6, {2, 1.5f, 0}}});
  addMover(s, 0.2f, {{0, {-2, 0.3f, -2}}, {4, {-2, 0.3f, -2}}, {8, {-2, 2, -2}}});
  addMover(s, 0.35f, {{0, {0, 1, -1}}, {9, {0, 1, -1}, turned}});
  addMover(s, 0.2f, {{0, {2, 0.3f, -2}, none, false}, {5, {2, 0.3f, -2}}, {7, {1.2f, 0.3f, -2}}});
  return s;
}

TEST(Kept, ShadowMapsOfWhatStands) {
  for (const uint32_t frames : {2u, 5u, 7u, 8u, kFrames}) {
    PassTest kept("shadow-map"), anew("shadow-map");
    for (PassTest* test : {&kept, &anew}) test->scene(movingScene()).param("size", 64);
    // If lights were elsewhere in the previous frame, nothing may be kept.
    anew.beforeFrame([&](PassTest&, scene::Frame& frame) {
      if (frame.index + 2 == frames) frame.lights[0].direction = {0, -1, 0};
    });
    kept.run(frames);
    anew.run(frames);
    EXPECT_TRUE(kept.bytes("maps.depth") == anew.bytes("maps.depth")) << frames << " frames";
  }
}

// Outputs of a graph in every frame, with what is kept and with everything computed anew.
void expectSame(const char* graph, const scene::Scene& scene, const std::vector<std::string>& set) {
  GraphRunOptions options;
  options.size = {64, 64};
  options.frames = kFrames;
  options.everyFrame = true;
  options.set = {"vpl_count=64", "attempts=128", "voxels=32", "map_size=16", "shadow_map_size=256"};
  options.set.insert(options.set.end(), set.begin(), set.end());
  const GraphRun kept = runGraph(graph, scene, options);
  options.set.push_back("light-inject.keep=false");
  const GraphRun anew = runGraph(graph, scene, options);
  size_t moved = 0;
  for (uint32_t i = 0; i < kFrames; ++i)
    for (const auto& [name, data] : kept.frames[i].outputs) {
      const std::vector<float> values = toFloats(data);
      EXPECT_TRUE(values == toFloats(anew.frames[i].outputs.at(name))) << name << ", frame " << i;
      moved += values != toFloats(kept.frames[0].outputs.at(name));
    }
  EXPECT_GT(moved, kFrames / 2);
}

TEST(Kept, LightOfWhatStands) { expectSame("debug/voxels", movingScene(), {"show=radiance"}); }

TEST(Kept, PicturesFromWhatIsKept) { expectSame("ours", movingScene(), {}); }

TEST(Kept, PicturesWhereMoversShareABox) { expectSame("ours", crowdedScene(), {}); }

template <class T>
std::vector<T> valuesOf(const graph::FrameResult& frame, const char* output) {
  const std::vector<std::byte>& bytes = frame.outputs.at(output).bytes;
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

// Runs tests/data/graphs/kept_light.json and returns the outputs of every frame.
GraphRun runLight(const scene::Scene& scene, bool keep) {
  GraphRunOptions options;
  options.frames = kFrames;
  options.everyFrame = true;
  options.outputs = {"voxels.info", "radiance", "changed", "mips.color", "anew.color"};
  options.set = {keep ? "light-inject.keep=true" : "light-inject.keep=false"};
  return runGraph(FOVEA_TEST_DATA "/graphs/kept_light.json", scene, options);
}

// `changed` says exactly which light on static surfaces differs from the previous frame, however many sides were
// looked up, and makes no mip that it should not.
void expectExactChanges(const scene::Scene& scene) {
  using Bits = std::array<uint32_t, 4>;
  const GraphRun kept = runLight(scene, true), anew = runLight(scene, false);
  std::vector<Bits> before(valuesOf<Bits>(kept.frames[0], "radiance").size(), Bits{});
  size_t changes = 0, stays = 0, shown = 0;
  for (uint32_t i = 0; i < kFrames; ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    const graph::FrameResult &a = kept.frames[i], &b = anew.frames[i];
    const auto info = valuesOf<scene::VoxelInfo>(a, "voxels.info").at(0);
    const auto light = valuesOf<Bits>(a, "radiance"), lightAnew = valuesOf<Bits>(b, "radiance");
    const auto changed = valuesOf<uint32_t>(a, "changed"), changedAnew = valuesOf<uint32_t>(b, "changed");
    shown += info.voxels > info.staticVoxels;
    for (uint32_t side = 0; side < 2 * info.voxels; ++side) {
      const bool moves = side >= 2 * info.staticVoxels, differs = light[side] != before[side];
      ASSERT_EQ(light[side], lightAnew[side]) << "side " << side;
      ASSERT_EQ(changed[side], uint32_t(moves || differs)) << "side " << side;
      ASSERT_EQ(changedAnew[side], changed[side]) << "side " << side;
      if (i > 0 && !moves) ++(differs ? changes : stays);
    }
    for (const graph::FrameResult* frame : {&a, &b})
      EXPECT_TRUE(frame->outputs.at("mips.color").bytes == frame->outputs.at("anew.color").bytes);
    EXPECT_TRUE(a.outputs.at("mips.color").bytes == b.outputs.at("mips.color").bytes);
    before = light;
  }
  EXPECT_GT(shown, kFrames / 2);
  EXPECT_GT(changes, 100u);
  EXPECT_GT(stays, changes);
}

TEST(Kept, ExactlyTheLightThatChangesIsToldChanged) { expectExactChanges(movingScene()); }

TEST(Kept, ExactlyTheLightThatChangesWhereMoversShareABox) {
  size_t movers = 0;
  for (const scene::Object& object : scene::flatten(crowdedScene()).objects) movers += object.dynamic;
  ASSERT_GT(movers, scene::MoverBoxes::kCount + 1);  // two share one, at least
  expectExactChanges(crowdedScene());
}

}  // namespace
}  // namespace fovea::test
