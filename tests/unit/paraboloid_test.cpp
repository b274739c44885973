#include "tests/references/paraboloid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace fovea::scene {
namespace {

std::vector<glm::vec3> testDirections() {
  std::vector<glm::vec3> list = {{1, 0, 0},          {-1, 0, 0},    {0, 1, 0}, {0, -1, 0},
                                 {0, 0, 1},          {0, 0, -1},    {0, 0, 1}, {1e-4f, 0, -1.0f},
                                 {0, -1e-4f, -1.0f}, {1, 0, -1e-8f}};
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 500; ++i) list.push_back({normal(random), normal(random), normal(random)});
  for (glm::vec3& d : list) d = glm::normalize(d);
  return list;
}

TEST(Paraboloid, FrameIsOrthonormalRightHandedAndKeepsTheNormal) {
  for (glm::vec3 n : testDirections()) {
    glm::mat3 f = orthonormalFrame(n);
    EXPECT_EQ(f[2], n);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(glm::dot(f[i], f[j]), i == j ? 1.0f : 0.0f, 2e-6f) << i << j;
    EXPECT_NEAR(glm::determinant(f), 1.0f, 4e-6f);
    EXPECT_LT(glm::length(toWorld(f, toLocal(f, n)) - n), 2e-6f);
    EXPECT_LT(glm::length(toLocal(f, n) - glm::vec3(0, 0, 1)), 2e-6f);
  }
}

TEST(Paraboloid, ProjectionAndDirectionAreInverse) {
  for (glm::vec3 d : testDirections()) {
    if (d.z < -0.5f) continue;
    glm::vec2 p = paraboloidProject(d, 1.0f);
    EXPECT_EQ(glm::dot(p, p) <= 1.0f + 1e-6f, d.z >= -1e-6f);
    EXPECT_LT(glm::length(paraboloidDirection(p) - d), 1e-6f);
    EXPECT_LT(glm::length(paraboloidProject(3.0f * d, 3.0f) - p), 1e-6f);
  }
}

TEST(Paraboloid, TexelCentresComeBackToTheirTexel) {
  for (int size : {1, 2, 7, 128, 1000}) {
    for (int y = 0; y < size; y += 1 + size / 50)
      for (int x = 0; x < size; x += 1 + size / 50) {
        glm::vec3 d = paraboloidTexelDirection({x, y}, size);
        EXPECT_NEAR(glm::length(d), 1.0f, 1e-6f);
        EXPECT_EQ(paraboloidTexel(paraboloidProject(d, 1.0f), size), glm::ivec2(x, y)) << size;
      }
  }
  // The axis, the corners and beyond stay inside the map.
  EXPECT_EQ(paraboloidTexel({0, 0}, 128), glm::ivec2(64, 64));
  EXPECT_EQ(paraboloidTexel({1, -1}, 128), glm::ivec2(127, 0));
  EXPECT_EQ(paraboloidTexel({9, -9}, 128), glm::ivec2(127, 0));
}

// Texels of equal size cover solid angles dw = 4 / (1 + |p|^2)^2 dp; over the disc they add up to the hemisphere.
TEST(Paraboloid, TexelsOfTheDiscCoverTheHemisphere) {
  const int size = 256;
  double solidAngle = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      glm::vec2 p = paraboloidTexelCentre({x, y}, size);
      double q = glm::dot(p, p);
      if (q < 1) solidAngle += 4.0 / ((1 + q) * (1 + q)) * 4.0 / (size * size);
    }
  EXPECT_NEAR(solidAngle, 2 * M_PI, 2 * M_PI * 1e-3);
}

TEST(Atlas, SlotsDoNotOverlapInEitherLayout) {
  for (uint32_t tiles : {1u, kAtlasTiles}) {
    const int size = 4;
    AtlasLayout layout = atlasLayout(size * int(tiles), size);
    ASSERT_EQ(layout.size, size);
    ASSERT_EQ(1u << layout.shift, tiles);
    std::vector<int> hits(size_t(size) * tiles * size * 10, 0);
    for (uint32_t slot = 0; slot < 10 * tiles; ++slot)
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          glm::ivec3 t = atlasTexel(slot, {x, y}, layout);
          ASSERT_LT(t.x, size * int(tiles));
          ASSERT_LT(t.y, size);
          ASSERT_LT(t.z, 10);
          ++hits[(size_t(t.z) * size + t.y) * size * tiles + t.x];
        }
    for (int h : hits) ASSERT_EQ(h, 1);
  }
}

}  // namespace
}  // namespace fovea::scene
