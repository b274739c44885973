// Cone tracing and accumulated paths from end to end.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "framework/scene/scene.h"
#include "tests/graphs/lit_sphere.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

double meanGreen(const std::vector<float>& image) {
  double sum = 0;
  for (size_t i = 1; i < image.size(); i += 4) sum += image[i] / double(image.size() / 4);
  return sum;
}

std::vector<float> indirect(const char* graph, const scene::Scene& s, uint32_t frames,
                            std::vector<std::string> set) {
  GraphRunOptions o;
  o.size = glm::uvec2(48);
  o.frames = frames;
  o.set = std::move(set);
  return toFloats(runGraph(graph, s, o).outputs.at("indirect"));
}

TEST(Alternatives, FurnaceIsLitByTwoBounces) {
  constexpr float kRho = 0.5f;
  const scene::Scene s = litSphere(kRho);
  const double want = litSphereRadiance(kRho, 2);
  EXPECT_NEAR(meanGreen(indirect("alternatives/vxgi", s, 4, {"voxels=48"})), want, 0.03 * want);
  EXPECT_NEAR(meanGreen(indirect("alternatives/pt_denoised", s, 4, {})), want, 0.01 * want);
}

// A room with a red wall, and a box that hides the lamp from a part of it.
scene::Scene room() {
  scene::Scene s;
  uint32_t walls[6];
  for (uint32_t& m : walls) m = addMaterial(s, glm::vec3(0.6f));
  s.materials[walls[0]].baseColor = {0.6f, 0.2f, 0.2f, 1};
  addRoom(s, walls, 2);
  s.materials[addMaterial(s, glm::vec3(0.7f))].doubleSided = true;
  addQuad(s, uint32_t(s.materials.size()) - 1, {-1, -0.6f, -0.5f}, {1.6f, 0, 0.3f}, {0, 0.9f, 0.8f});
  s.lights = {pointLight({0.4f, 1.3f, 0.2f}, glm::vec3(4))};
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 0, 1.8f};
  s.cameras[0].verticalFov = 1.4f;
  return s;
}

// Accumulated paths are those of the reference. Cones keep the light, but blur where it arrives.
TEST(Alternatives, LightIsThatOfTracedPaths) {
  const scene::Scene s = room();
  const auto want = indirect("reference", s, 1, {"spp=256"});
  const auto paths = indirect("alternatives/pt_denoised", s, 4, {"spp=48"}),
             cones = indirect("alternatives/vxgi", s, 12, {"voxels=48"});
  double error = 0, total = 0;
  for (size_t i = 0; i < want.size(); ++i) {
    if (i % 4 == 3) continue;
    error += std::abs(cones[i] - want[i]);
    total += want[i];
  }
  std::printf("[ MEASURED ] light of pt_denoised / traced paths: %.4f; of vxgi %.3f, mean error %.3f\n",
              meanGreen(paths) / meanGreen(want), meanGreen(cones) / meanGreen(want), error / total);
  EXPECT_NEAR(meanGreen(paths) / meanGreen(want), 1, 0.01);
  EXPECT_NEAR(meanGreen(cones) / meanGreen(want), 1, 0.05);
  EXPECT_LT(error / total, 0.2);
}

}  // namespace
}  // namespace fovea::test
