#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "fovea/scene.h"
#include "fovea/test.h"
#include "framework/base/random.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/support/shapes.h"
#include "tests/support/voxels.h"

namespace fovea::test {
namespace {

constexpr int kVpls = 70;

struct Box {
  scene::Scene scene = scene::builtin("cornellbox");
  VoxelArrays voxels = voxelizeReference(scene, scene::flatten(scene), 16);
  std::vector<scene::VplState> vpls;
  std::vector<glm::vec4> radiosity;

  Box() {
    for (uint32_t i = 0; i < kVpls; ++i) {
      const auto random = [&](uint32_t what) { return uniformFloat(randomStream(5, 0, what, i)); };
      scene::VplState v;
      v.position = {random(0), random(1), random(2)};
      v.normal = glm::normalize(glm::vec3(random(3), random(4), random(5)) - 0.5f);
      v.life = float(i % 3);
      vpls.push_back(v);
      radiosity.emplace_back(random(6), random(7), random(8), 1);
    }
  }
  std::vector<scene::Vpl> place(double offset, double least = 0) {
    PassTest test("vpl-origins");
    test.scene(scene).param("offset", offset).param("least", least);
    setVoxels(test, voxels);
    test.buffer("vpls", vpls, "VplState").buffer("radiosity", radiosity, "VplRadiosity");
    test.run();
    return test.values<scene::Vpl>("placed");
  }
};

bool isEmpty(const scene::Vpl& v) {
  const scene::Vpl none;
  return std::memcmp(&v, &none, sizeof v) == 0;
}

TEST(Place, OutOfTheSurfaceAlongTheNormal) {
  Box box;
  for (const double offset : {0.0, 0.5}) {
    const auto list = box.place(offset);
    ASSERT_EQ(list.size(), box.vpls.size());
    for (size_t i = 0; i < list.size(); ++i) {
      const scene::VplState& v = box.vpls[i];
      if (!(v.life > 0)) {
        EXPECT_TRUE(isEmpty(list[i])) << i;
        continue;
      }
      const glm::vec3 want = v.position + float(offset) * box.voxels.grid.cell * v.normal;
      EXPECT_LT(glm::distance(list[i].position, want), 1e-6f) << i;
      EXPECT_EQ(list[i].normal, v.normal) << i;
      EXPECT_EQ(list[i].area, 1) << i;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(list[i].intensity[c], box.radiosity[i][c] / 3.14159265f, 1e-6f) << i;
    }
  }
}

TEST(Place, WhatIsNoNumberIsLeftOut) {
  Box box;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (scene::VplState& v : box.vpls) v.life = 1;
  box.radiosity[0] = glm::vec4(nan);
  box.radiosity[1].y = inf;
  box.vpls[2].position.z = nan;
  box.vpls[3].normal.x = inf;
  box.radiosity[4] = glm::vec4(-1);
  const auto list = box.place(0.15);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(isEmpty(list[size_t(i)])) << i;
  EXPECT_EQ(list[4].intensity, glm::vec3(0));
  EXPECT_FALSE(isEmpty(list[5]));
}

TEST(Place, ADarkVplIsNotEmptyWithALeastIntensity) {
  Box box;
  for (scene::VplState& v : box.vpls) v.life = 1;
  box.vpls[1] = {};
  box.radiosity[0] = glm::vec4(0);
  box.radiosity[2] = glm::vec4(-1);
  const auto list = box.place(0.15, 1e-6);
  EXPECT_EQ(list[0].intensity, glm::vec3(1e-6f));
  EXPECT_TRUE(isEmpty(list[1]));
  EXPECT_EQ(list[2].intensity, glm::vec3(1e-6f));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(list[3].intensity[c], box.radiosity[3][c] / 3.14159265f, 1e-6f);
}

}  // namespace
}  // namespace fovea::test
