// Tests the weights of what the eye sees: closed forms on a wall, and random G-buffers against a plain loop
// over the pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "framework/scene/scene.h"
#include "tests/passes/weight_map_reference.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using Pixel = WeighedPixel;
using Picture = WeighedPicture;

constexpr int kResolution = 16;

float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(23, 0, what, i)); }

// A room of 2 m with a panel in it that is seen from both sides.
scene::Scene room() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  const uint32_t materials[6] = {grey, grey, grey, grey, grey, grey};
  addRoom(s, materials, 1);
  addQuad(s, grey, {-0.4f, -0.9f, -0.31f}, {0.7f, 0, 0.1f}, {0, 1.1f, 0});
  addQuad(s, grey, {-0.4f, -0.9f, -0.32f}, {0, 1.1f, 0}, {0.7f, 0, 0.1f});
  scene::Camera camera;
  camera.position = {0.3f, 0.2f, 0.9f};
  s.cameras.push_back(camera);
  return s;
}

void expectEqual(const PassTest& test, const SideWeights& expected) {
  const std::vector<float> weights = test.values<float>("weights");
  ASSERT_EQ(weights.size(), expected.weights.size());
  for (size_t i = 0; i < weights.size(); ++i)
    ASSERT_NEAR(weights[i], expected.weights[i], 2e-7f) << "side " << i;
  EXPECT_EQ(test.counter("visible"), expected.visible);
  EXPECT_EQ(test.counter("unassigned"), expected.unassigned);
}

// Patches of a few pixels, seen from the middle of the room, most of them in a cell with a surface, some in the
// background, outside the grid, or with a face for which the cell has no side.
Picture randomPicture(int width, int height, const VoxelArrays& voxels) {
  const int r = voxels.resolution;
  const auto voxelAt = [&](glm::vec3 position) {
    const glm::ivec3 cell(glm::floor(voxels.grid.worldToVoxel(position)));
    const bool inside = cell == glm::clamp(cell, glm::ivec3(0), glm::ivec3(r - 1));
    return inside ? voxels.index[size_t(cell.x + r * (cell.y + r * cell.z))] : 0;
  };
  Picture picture(
      width, height,
      raysOnto({0.1f, 0.2f, 0.9f}, {-1, 1, -1}, {2 / float(width), 0, 0}, {0, -2 / float(height), 0}));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const uint32_t patch = uint32_t((x + y % 3) / 5 + 100 * (y / 3)), pixel = uint32_t(x + 1000 * y);
      Pixel& p = picture.at(x, y);
      // The first of some distances at which a surface may be; most of what is nearer is an empty cell.
      uint32_t voxel = 0;
      for (uint32_t i = 0; i < 200 && voxel == 0; ++i) {
        p.distance = 4 * random(8 + i, patch);
        p.position = pointOn(picture.camera, x, y, p.distance);
        voxel = voxelAt(p.position);
      }
      if (random(5, patch) < 0.05f) p.distance = 9;
      if (random(5, patch) > 0.95f) p.distance *= 0.3f;
      p.position = pointOn(picture.camera, x, y, p.distance);
      if (random(0, patch) < 0.1f) p.distance = 0;
      if (voxel == 0) continue;
      voxel -= 1;
      const uint32_t wanted = random(6, patch) < 0.5f ? 0u : 1u;
      const bool other = voxels.surface[2 * voxel + wanted].area <= 0;
      p.face = voxels.surface[2 * voxel + (other ? 1 - wanted : wanted)].normal;
      if (random(7, pixel) < 0.1f) p.face = -p.face;
    }
  return picture;
}

TEST(WeightMap, EqualsTheReference) {
  const scene::Scene s = room();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), kResolution);
  struct Case {
    glm::ivec2 size;
    int spacing;
  };
  for (const auto [size, spacing] :
       {Case{{101, 77}, 1}, Case{{64, 64}, 1}, Case{{3, 2}, 1}, Case{{203, 154}, 2}, Case{{3, 2}, 16}}) {
    PassTest test("weight-map");
    test.scene(s).view("fovea_radius", 0.2).param("spacing", spacing);
    setVoxels(test, voxels);
    const Picture picture = randomPicture(size.x, size.y, voxels);
    picture.wire(test);
    test.beforeFrame([](PassTest&, scene::Frame& frame) { frame.views[0].gaze = {0.3f, 0.6f}; });
    test.run();
    const SideWeights expected =
        weightsReference(picture, voxels, test.lastFrame().views[0].eye, {0.3f, 0.6f}, 0.2f, spacing);
    expectEqual(test, expected);
    if (size.x < 50) continue;
    EXPECT_GT(expected.visible, 200);  // the test is not vacuous
    EXPECT_GT(expected.unassigned, 100);
  }
}

// A wall across the whole image, with one pixel per cell and so on: a side is known only from its own pixels.
Picture wallPicture(int size) {
  const float step = 0.995f * 2 / float(size);
  const glm::vec3 first(0.5f * step - 0.995f, 0.995f - 0.5f * step, -1);
  Picture picture(size, size, raysOnto({0, 0, 1}, first, {step, 0, 0}, {0, -step, 0}));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      Pixel& p = picture.at(x, y);
      const glm::vec2 at = 2.0f * (glm::vec2(x, y) + 0.5f) / float(size) - 1.0f;
      p.position = {0.995f * at.x, -0.995f * at.y, -1};
      p.distance = 2;
    }
  return picture;
}

std::vector<float> wallWeights(PassTest& test, const VoxelArrays& voxels, glm::vec2 gaze,
                               const Picture& picture) {
  setVoxels(test, voxels);
  picture.wire(test);
  test.beforeFrame([gaze](PassTest&, scene::Frame& frame) { frame.views[0].gaze = gaze; });
  test.run();
  return test.values<float>("weights");
}

// With `falloff` `centre` the largest weight of a side is 1 / r of its pixel nearest to the gaze.
TEST(WeightMap, FallsFromTheGaze) {
  const scene::Scene s = room();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), kResolution);
  const Picture picture = wallPicture(96);
  PassTest test("weight-map");
  test.scene(s).param("falloff", "centre");
  wallWeights(test, voxels, {0.4f, 0.6f}, picture);
  const float pixel = 1.0f / 96;  // the radius of a fovea of one pixel
  expectEqual(test, weightsReference(picture, voxels, test.lastFrame().views[0].eye, {0.4f, 0.6f}, pixel));
  const auto weights = test.values<float>("weights");
  EXPECT_GT(std::ranges::max(weights), 0.5f);
  EXPECT_LT(std::ranges::count_if(weights, [](float w) { return w > 0.1f; }), 20);
}

// The weight is exactly 1 inside the disc and r_f / r at the nearest pixel outside: continuous across the disc's
// edge, wherever the gaze is.
TEST(WeightMap, FallsOutsideTheDisc) {
  const scene::Scene s = room();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), kResolution);
  const int size = 96;
  const Picture picture = wallPicture(size);
  for (const glm::vec2 gaze : {glm::vec2(0.5f), glm::vec2(0.1f, 0.95f), glm::vec2(-1.5f, 0.5f)}) {
    PassTest test("weight-map");
    const auto weights = wallWeights(test.scene(s), voxels, gaze, picture);
    const double radius = 0.25 * size;
    std::map<uint32_t, double> nearest;  // side -> distance of its nearest pixel from the gaze
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const glm::ivec3 cell(glm::floor(voxels.grid.worldToVoxel(picture.at(x, y).position)));
        const uint32_t side =
            2 * (voxels.index[size_t(cell.x + kResolution * (cell.y + kResolution * cell.z))] - 1);
        const double r = glm::distance(glm::dvec2(x + 0.5, y + 0.5), glm::dvec2(gaze) * double(size));
        nearest[side] = nearest.contains(side) ? std::min(nearest[side], r) : r;
      }
    double sum = 0;
    for (const auto& [side, r] : nearest) {
      ASSERT_NEAR(weights[side], r <= radius ? 1.0 : radius / r, 1e-6);
      sum += weights[side];
    }
    EXPECT_EQ(test.counter("visible"), double(nearest.size()));
    EXPECT_EQ(test.counter("unassigned"), 0);
    double all = 0;
    for (const float w : weights) all += w;
    EXPECT_NEAR(all, sum, 1e-3);  // nothing else is seen
    if (gaze.x < 0) {
      EXPECT_LT(*std::max_element(weights.begin(), weights.end()), 0.2f);
    }
  }
}

TEST(WeightMap, RegionImageWeighsAllThatIsSeenAlike) {
  const scene::Scene s = room();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), kResolution);
  PassTest test("weight-map");
  test.scene(s).param("region", "image");
  double seen = 0;
  for (const float w : wallWeights(test, voxels, {0.1f, 0.1f}, wallPicture(96))) {
    EXPECT_TRUE(w == 0 || w == 1);
    seen += w;
  }
  EXPECT_EQ(test.counter("visible"), seen);
  EXPECT_GT(seen, 200);
}

// Nothing is left from the previous frame.
TEST(WeightMap, ForgetsTheLastFrame) {
  const scene::Scene s = room();
  const VoxelArrays voxels = voxelizeReference(s, scene::flatten(s), kResolution);
  Picture picture = wallPicture(64);
  PassTest test("weight-map");
  wallWeights(test.scene(s), voxels, glm::vec2(0.5f), picture);
  EXPECT_GT(test.counter("visible"), 200);
  for (Pixel& p : picture.pixels) p.distance = 0;
  test.set("gbuffer.distance", picture.distances());
  test.run();
  EXPECT_EQ(test.counter("visible"), 0);
  for (const float w : test.values<float>("weights")) ASSERT_EQ(w, 0);
}

// Without triangles the grid is empty, and the G-buffer does not match it.
TEST(WeightMap, EmptySceneHasNothingToWeigh) {
  scene::Scene s;
  PassTest test("weight-map");
  test.scene(s);
  const VoxelArrays nothing = voxelizeReference(s, scene::flatten(s), kResolution);
  const auto weights = wallWeights(test, nothing, glm::vec2(0.5f), wallPicture(32));
  EXPECT_GE(weights.size(), 1u);
  for (const float w : weights) EXPECT_EQ(w, 0);
  EXPECT_EQ(test.counter("visible"), 0);
  EXPECT_EQ(test.counter("unassigned"), 32 * 32);
}

}  // namespace
}  // namespace fovea::test
