// Tests that an environment map lights the pictures of whole graphs as it does in the path tracer.
#include <gtest/gtest.h>

#include <memory>

#include "framework/scene/environment/environment_map.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

// A dark floor with a table on it, whose light comes from a map alone, brighter on one side below the zenith.
scene::Scene tableInTheOpen() {
  scene::Scene s;
  addQuad(s, addMaterial(s, glm::vec3(0.2f)), {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  const uint32_t wood = addMaterial(s, {0.3f, 0.2f, 0.1f});
  s.materials[wood].doubleSided = true;
  addQuad(s, wood, {-1, 0.7f, 1}, {2, 0, 0}, {0, 0, -2});
  std::vector<glm::vec3> texels(32 * 16, glm::vec3(1, 1.2f, 1.5f));
  for (size_t i = 0; i < texels.size(); ++i) texels[i] *= i % 32 < 8 ? 1 + 0.2f * float(i / 32) : 1.0f;
  s.environmentMap = std::make_shared<scene::EnvironmentMap>(32, 16, texels);
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 4, 4};
  s.cameras[0].orientation = glm::angleAxis(glm::radians(-48.0f), glm::vec3(1, 0, 0));
  s.cameras[0].verticalFov = 0.7f;
  return s;
}

// The mean of a channel in the whole picture, and in the rows that show what is below the table.
std::pair<double, double> meansOf(const std::string& graph, uint32_t frames, std::vector<std::string> set,
                                  const std::string& output = "radiance") {
  constexpr uint32_t kSide = 48;
  GraphRunOptions o;
  o.size = glm::uvec2(kSide);
  o.frames = frames;
  o.set = std::move(set);
  o.outputs = {output};
  const std::vector<float> image = toFloats(runGraph(graph, tableInTheOpen(), o).outputs.at(output));
  double all = 0, below = 0;
  for (size_t i = 0; i < image.size(); i += 4) {
    const size_t x = i / 4 % kSide, y = i / 4 / kSide;
    all += double(image[i + 1]) / (kSide * kSide);
    if (y >= 27 && y < 30 && x >= 18 && x < 30) below += double(image[i + 1]) / 36;
  }
  return {all, below};
}

TEST(Sky, LightsWhatVplsDoNot) {
  const auto [all, below] = meansOf("reference", 1, {"spp=256"});
  EXPECT_LT(below, 0.7 * all);
  for (const char* graph : {"ours", "ir_1000", "foveal"}) {
    const auto [gotAll, gotBelow] = meansOf(graph, 8, {"vpl_count=200", "map_size=32", "shadow_map_size=64"});
    EXPECT_NEAR(gotAll, all, 0.04 * all) << graph;
    EXPECT_NEAR(gotBelow, below, 0.1 * below) << graph;
  }
  // The other eye sees more of what is below the table than it can take from the first.
  for (const char* graph : {"stereo", "ir_stereo"}) {
    const std::vector<std::string> set{"vpl_count=200", "map_size=32", "shadow_map_size=64"};
    const auto [left, leftBelow] = meansOf(graph, 8, set);
    const auto [right, rightBelow] = meansOf(graph, 8, set, "radiance_right");
    EXPECT_NEAR(right, left, 0.04 * left) << graph;
    EXPECT_NEAR(rightBelow, leftBelow, 0.1 * leftBelow) << graph;
  }
  const auto [cones, conesBelow] = meansOf("alternatives/vxgi", 8, {"voxels=96", "shadow_map_size=64"});
  EXPECT_NEAR(cones, all, 0.04 * all);
  EXPECT_NEAR(conesBelow, below, 0.3 * below);
}

}  // namespace
}  // namespace fovea::test
