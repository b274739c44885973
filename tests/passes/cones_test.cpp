// Compares the irradiance of pixels by cones with the gather on the CPU.
#include <gtest/gtest.h>

#include <memory>

#include "framework/base/random.h"
#include "framework/scene/environment/environment_map.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/voxel_light.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr int kSize = 24;

// A room with a board in it, lit unevenly.
VoxelScene room() {
  scene::Scene s;
  const uint32_t m = addMaterial(s, {0.5f, 0.25f, 0.75f});
  const uint32_t all[6] = {m, m, m, m, m, m};
  addRoom(s, all, 1);
  addQuad(s, m, {-0.9f, -0.4f, -0.9f}, {0, 0.3f, 0.8f}, {0.8f, 0.2f, 0});
  return {s, 32};
}

glm::vec3 uneven(const scene::VoxelSide& v) {
  return glm::vec3(1.5f, 1, 0.5f) * (2.0f + v.position.x + 0.5f * v.normal.y);
}

// The floor, slanted normals on it, and background in one corner.
GBuffer floorOf() {
  const float step = 1.6f / kSize;
  return {kSize, kSize, raysOnto({0, 2, 0}, {-0.8f, -1, -0.8f}, {step, 0, 0}, {0, 0, step}),
          [](int x, int y) {
            SurfacePixel p;
            p.position = {1.6f * float(x) / kSize - 0.8f, -1, 1.6f * float(y) / kSize - 0.8f};
            p.normal = glm::normalize(glm::vec3(0.02f * float(x - 12), 1, 0.02f * float(y - 12)));
            p.distance = x < 4 && y < 4 ? 0.0f : 3.0f;
            return p;
          }};
}

std::vector<float> cones(const VoxelScene& s, const std::vector<glm::vec4>& radiance, const MipRun& mips,
                         const GBuffer& seen, uint32_t frames) {
  PassTest test("cones");
  test.scene(s.scene).seed(3);
  setVoxels(test, s.voxels);
  test.buffer("radiance", radiance, "VoxelRadiance");
  setMips(test, mips);
  seen.wire(test);
  test.run(frames);
  return test.floats("irradiance");
}

TEST(Cones, EqualTheGatherOnTheCpu) {
  const VoxelScene s = room();
  const auto radiance = radianceOf(s, uneven);
  const MipRun mips = runMips(s, radiance, true);
  const GBuffer seen = floorOf();
  for (const uint32_t frames : {1u, 3u}) {
    const auto got = cones(s, radiance, mips, seen, frames);
    double error = 0, total = 0;
    int off = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const float* light = &got[4 * size_t(y * kSize + x)];
        const SurfacePixel& p = seen.at(x, y);
        if (p.distance == 0) {
          EXPECT_EQ(glm::vec4(light[0], light[1], light[2], light[3]), glm::vec4(0));
          continue;
        }
        EXPECT_EQ(light[3], 1);
        const uint32_t number = randomStream(3, uint32_t(x), 0x636f6e65u, uint32_t(y));
        const float turn = glm::two_pi<float>() * uniformFloat(number + (frames - 1) * 2654435769u);
        const glm::vec3 want =
            referenceGather(s, mips.mips, radiance, p.position, glm::normalize(p.normal), turn) /
            glm::pi<float>();
        const double d = glm::length(glm::vec3(light[0], light[1], light[2]) - want);
        off += d > 5e-3 * glm::length(want);  // rounding may select another level or voxel
        error += d;
        total += glm::length(want);
      }
    EXPECT_LT(off, kSize * kSize / 50);
    EXPECT_LT(error / total, 2e-3);
  }
}

// If every surface emits the radiance L, L arrives everywhere.
TEST(Cones, Furnace) {
  const VoxelScene s = room();
  const glm::vec3 light(2, 1, 0.5f);
  const auto radiance = radianceOf(s, [&](auto&) { return light; });
  const auto got = cones(s, radiance, runMips(s, radiance, true), floorOf(), 1);
  double mean = 0;
  for (size_t i = 0; i < got.size(); i += 4) mean += double(got[i + 1]) / (kSize * kSize - 16);
  EXPECT_NEAR(mean, light.g, 0.01 * light.g);
}

// Cones that nothing stops find the environment map: on a lone floor they bring back its mean light.
TEST(Cones, SeeTheEnvironment) {
  scene::Scene open;
  addQuad(open, addMaterial(open, glm::vec3(0.5f)), {-2, -1, 2}, {4, 0, 0}, {0, 0, -4});
  const glm::vec3 light(2, 1, 0.5f);
  open.environmentMap = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, light));
  const VoxelScene s{open, 32};
  const auto radiance = radianceOf(s, [](auto&) { return glm::vec3(0); });
  const auto got = cones(s, radiance, runMips(s, radiance, true), floorOf(), 1);
  double mean = 0;
  for (size_t i = 0; i < got.size(); i += 4) mean += double(got[i + 1]) / (kSize * kSize - 16);
  EXPECT_NEAR(mean, light.g, 0.02 * light.g);
}

}  // namespace
}  // namespace fovea::test
