#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "framework/base/random.h"
#include "tests/passes/voxel_light.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

std::vector<glm::vec4> bounced(const VoxelScene& s, const std::vector<glm::vec4>& radiance,
                               const std::vector<glm::vec4>* direct = nullptr) {
  const MipRun mips = runMips(s, radiance, true);
  PassTest test("bounce");
  test.scene(s.scene);
  setVoxels(test, s.voxels);
  test.buffer("radiance", radiance, "VoxelRadiance");
  if (direct) test.buffer("direct", *direct, "VoxelRadiance");
  setMips(test, mips);
  test.run();
  return test.values<glm::vec4>("bounced");
}

scene::Scene room(glm::vec3 rho) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, rho);
  const uint32_t all[6] = {m, m, m, m, m, m};
  addRoom(s, all, 1);
  return s;
}

TEST(Bounce, EqualsTheReference) {
  scene::Scene model = room({0.5f, 0.25f, 0.75f});
  addHollowSphere(model, 0, {0.2f, -0.3f, 0}, 0.4f, 16, 8);
  const VoxelScene s(model, 32);
  const auto radiance = radianceOf(s, [](const scene::VoxelSide& v) { return glm::vec3(1.2f + v.position); });
  const auto got = bounced(s, radiance);
  const Mips mips = runMips(s, radiance, true).mips;
  size_t compared = 0, off = 0;
  for (uint32_t i = 0; i < s.sides().size(); ++i) {
    const scene::VoxelSide& side = s.sides()[i];
    if (side.area <= 0) {
      ASSERT_EQ(got[i], glm::vec4(0));
      continue;
    }
    if (i % 5) continue;
    const glm::uvec3 cell(glm::max(s.voxels.grid.worldToVoxel(side.position), glm::vec3(0)));
    const uint32_t bits = randomStream(0xb0, cell.x, cell.y, 2 * cell.z + (i & 1));
    const glm::vec3 e = referenceGather(s, mips, radiance, side.position, side.normal,
                                        glm::two_pi<float>() * uniformFloat(bits));
    const glm::vec3 want = glm::vec3(radiance[i]) + side.reflectance * e / glm::pi<float>();
    off += glm::length(glm::vec3(got[i]) - want) > 5e-3f * glm::length(want);
    EXPECT_NEAR(got[i].w, luminance(got[i]), 1e-4f * got[i].w);
    ++compared;
  }
  EXPECT_GT(compared, 300u);
  EXPECT_LT(off, compared / 50);
}

// All surfaces emit 1; with reflectance rho every bounce adds one more power of rho.
TEST(Bounce, FurnaceIsAGeometricSeries) {
  const float rho = 0.5f;
  const VoxelScene s(room(glm::vec3(rho)), 32);
  const auto emitted = radianceOf(s, [](auto&) { return glm::vec3(1); });
  std::vector<glm::vec4> radiance = emitted;
  double want = 1;
  for (int bounce = 1; bounce <= 3; ++bounce) {
    radiance = bounced(s, radiance, bounce == 1 ? nullptr : &emitted);
    want += std::pow(rho, bounce);
    double mean = 0, area = 0;
    for (uint32_t i = 0; i < s.sides().size(); ++i) {
      mean += double(s.sides()[i].area) * radiance[i].g;
      area += s.sides()[i].area;
    }
    EXPECT_NEAR(mean / area, want, 0.01 * want) << bounce;
  }
}

TEST(Bounce, NothingThere) {
  const VoxelScene s({}, 8);
  const std::vector<glm::vec4> radiance(2, glm::vec4(0));
  bounced(s, radiance);
}

}  // namespace
}  // namespace fovea::test
