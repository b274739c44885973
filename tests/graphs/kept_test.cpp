// What is kept from frame to frame while only some things move is what would be made anew, to the bit.
#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include "framework/scene/frame.h"
#include "tests/passes/ray_reference.h"
#include "tests/support/pass_test.h"

namespace fovea::test {
namespace {

// A floor, a wall, and a box that slides and turns; a sun, a lamp and a bulb that stay.
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

TEST(Kept, ShadowMapsOfWhatStands) {
  for (const uint32_t frames : {2u, 5u, 7u, 8u, kFrames}) {
    PassTest kept("shadow-map"), anew("shadow-map");
    for (PassTest* test : {&kept, &anew}) test->scene(movingScene()).param("size", 64);
    // Lights that were elsewhere in the frame before let nothing be kept.
    anew.beforeFrame([&](PassTest&, scene::Frame& frame) {
      if (frame.index + 2 == frames) frame.lights[0].direction = {0, -1, 0};
    });
    kept.run(frames);
    anew.run(frames);
    EXPECT_TRUE(kept.bytes("maps.depth") == anew.bytes("maps.depth")) << frames << " frames";
  }
}

// Of every frame, the outputs of a graph with what is kept and with everything made anew.
void expectSame(const char* graph, const std::vector<std::string>& set) {
  GraphRunOptions options;
  options.size = {64, 64};
  options.frames = kFrames;
  options.everyFrame = true;
  options.set = {"vpl_count=64", "attempts=128", "voxels=32", "map_size=16", "shadow_map_size=256"};
  options.set.insert(options.set.end(), set.begin(), set.end());
  const GraphRun kept = runGraph(graph, movingScene(), options);
  options.set.push_back("light-inject.keep=false");
  const GraphRun anew = runGraph(graph, movingScene(), options);
  size_t moved = 0;
  for (uint32_t i = 0; i < kFrames; ++i)
    for (const auto& [name, data] : kept.frames[i].outputs) {
      const std::vector<float> values = toFloats(data);
      EXPECT_TRUE(values == toFloats(anew.frames[i].outputs.at(name))) << name << ", frame " << i;
      moved += values != toFloats(kept.frames[0].outputs.at(name));
    }
  EXPECT_GT(moved, kFrames / 2);
}

TEST(Kept, LightOfWhatStands) { expectSame("debug_voxels", {"show=radiance"}); }

TEST(Kept, PicturesFromWhatIsKept) { expectSame("ours", {}); }

}  // namespace
}  // namespace fovea::test
