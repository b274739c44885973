// Tests that a room lit by long tubes close to its ceiling and to a wall keeps its light: most of it comes from short
// pieces of the tubes, straight and by way of the narrow bright strips beside them.
#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include "tests/graphs/corner.h"

namespace fovea::test {
namespace {

constexpr float kHalf = 1.3f;  // of the room's edge, m

// The side of a prism of 1.2 m about a line, whose quads are as long as it is.
void addTube(scene::Scene& s, uint32_t material, glm::vec3 middle, glm::vec3 along, glm::vec3 across) {
  constexpr int kSides = 8;
  constexpr float kLength = 1.2f, kRadius = 0.013f;
  const auto corner = [&](int side) {
    const float angle = glm::two_pi<float>() * float(side) / kSides;
    return kRadius * (std::cos(angle) * across + std::sin(angle) * glm::cross(along, across));
  };
  for (int side = 0; side < kSides; ++side)
    addQuad(s, material, middle - 0.5f * kLength * along + corner(side), corner(side + 1) - corner(side),
            kLength * along);
}

scene::Scene tubeRoom() {
  scene::Scene s;
  s.materials.clear();
  const uint32_t wall = addMaterial(s, glm::vec3(0.7f)), walls[6] = {wall, wall, wall, wall, wall, wall};
  addRoom(s, walls, kHalf);
  const uint32_t tube = addMaterial(s, glm::vec3(0.7f));
  s.materials[tube].emission = glm::vec3(20);
  addTube(s, tube, {-0.5f, kHalf - 0.06f, 0}, {0, 0, 1}, {1, 0, 0});  // below the ceiling
  addTube(s, tube, {0.7f, 0, 0.05f - kHalf}, {0, 1, 0}, {1, 0, 0});   // upright before the back wall
  const uint32_t tray = addMaterial(s, glm::vec3(0.8f));
  addQuad(s, tray, {-0.55f, kHalf - 0.03f, -0.7f}, {0.1f, 0, 0}, {0, 0, 1.4f});
  addQuad(s, tray, {0.65f, -0.7f, 0.02f - kHalf}, {0.1f, 0, 0}, {0, 1.4f, 0});
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 0, 1.2f};
  s.cameras[0].verticalFov = 2 * std::atan(0.8f);
  return s;
}

struct Part {  // of the picture, pixels
  std::string name;
  uint32_t left, top, right, bottom;
};
const std::vector<Part> kParts{{"ceiling", 18, 0, 36, 5},
                               {"back wall", 8, 12, 22, 28},
                               {"floor", 5, 35, 35, 40},
                               {"left wall", 0, 10, 5, 30}};

// The mean light of each part of the picture.
std::vector<double> lightOfParts(const std::string& graph, uint32_t seed, uint32_t frames,
                                 const std::vector<std::string>& set) {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.seed = seed;
  options.frames = frames;
  options.outputs = {"radiance"};
  options.set = set;
  const GraphRun run = runGraph(graph, tubeRoom(), options);
  const std::vector<float> picture = toFloats(run.outputs.at("radiance"));
  std::vector<double> light;
  for (const Part& part : kParts) {
    double sum = 0;
    for (uint32_t y = part.top; y < part.bottom; ++y)
      for (uint32_t x = part.left; x < part.right; ++x)
        sum += double(picture[(y * kSide + x) * (picture.size() / kSide / kSide)]);
    light.push_back(sum / double((part.bottom - part.top) * (part.right - part.left)));
  }
  return light;
}

// With rays aimed at any point of a tube, a seed is off by up to 0.17.
TEST(LongTubes, WallsAndCeilingKeepTheirLight) {
  const std::vector<double> want = lightOfParts("reference", 1, 1, {"spp=2048"});
  constexpr uint32_t kSeeds = 8;
  std::vector<double> got(kParts.size());
  for (uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<double> its = lightOfParts("foveal", seed, 4, {});
    for (size_t i = 0; i < got.size(); ++i) {
      got[i] += its[i] / kSeeds;
      EXPECT_NEAR(its[i], want[i], 0.13 * want[i]) << kParts[i].name << ", seed " << seed;
    }
  }
  for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], want[i], 0.06 * want[i]) << kParts[i].name;
}

}  // namespace
}  // namespace fovea::test
