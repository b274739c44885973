#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "framework/base/random.h"
#include "tests/passes/voxel_light.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

struct Cell {
  glm::dvec4 color{0};
  double weight = 0;
};

Cell operator+(const Cell& a, const Cell& b) { return {a.color + b.color, a.weight + b.weight}; }
Cell operator*(double f, const Cell& c) { return {f * c.color, f * c.weight}; }

// Where the near one leaves room, the far one shows.
Cell behind(const Cell& near, const Cell& far, bool directional) {
  const double room = far.color.a > 0 ? std::clamp((1 - near.color.a) / far.color.a, 0.0, 1.0) : 1.0;
  return near + (directional ? room : 1.0) * far;
}

struct Level {
  int size = 0;
  std::vector<Cell> cells;  // face after face
  Cell& at(int face, glm::ivec3 p) {
    return cells[size_t(p.x) +
                 size_t(size) * (size_t(p.y) + size_t(size) * (size_t(p.z) + size_t(size) * size_t(face)))];
  }
};

glm::dvec3 faceNormal(int face) {
  glm::dvec3 n(0);
  n[face / 2] = face % 2 ? -1 : 1;
  return n;
}

Cell voxelTowards(const VoxelScene& s, const std::vector<glm::vec4>& radiance,
                  const std::vector<float>& weights, glm::ivec3 cell, int face, bool directional) {
  Cell sum;
  if (glm::any(glm::greaterThanEqual(cell, glm::ivec3(s.voxels.resolution)))) return sum;
  const uint32_t voxel = s.voxels.voxelAt(cell);
  for (uint32_t side = 2 * voxel - 2; voxel && side < 2 * voxel; ++side) {
    double coverage = double(std::max(s.sides()[side].area, s.sides()[side].emissionArea)) /
                      (double(s.voxels.grid.cell) * s.voxels.grid.cell);
    if (directional)
      coverage *= std::max(0.0, glm::dot(glm::dvec3(s.sides()[side].normal), faceNormal(face)));
    sum = sum + coverage * Cell{glm::dvec4(glm::dvec3(radiance[side]), 1),
                                weights.empty() ? 0.0 : double(weights[side])};
  }
  return sum;
}

// Next level as a function of the finer level's cells.
template <class F>
Level halve(int size, int faces, bool directional, F child) {
  Level level{size, std::vector<Cell>(size_t(faces) * size * size * size)};
  for (int face = 0; face < faces; ++face)
    for (int z = 0; z < size; ++z)
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const int axis = face / 2;
          Cell sum;
          for (int column = 0; column < 4; ++column) {
            glm::ivec3 near(0);
            near[(axis + 1) % 3] = column & 1;
            near[(axis + 2) % 3] = column >> 1;
            glm::ivec3 far = near;
            (face % 2 ? far : near)[axis] = 1;
            const glm::ivec3 corner = 2 * glm::ivec3(x, y, z);
            sum = sum + behind(child(face, corner + near), child(face, corner + far), directional);
          }
          level.at(face, {x, y, z}) = 0.25 * sum;
        }
  return level;
}

void expectReference(const VoxelScene& s, bool directional, bool weighted) {
  std::vector<float> weights;
  const auto radiance =
      radianceOf(s, [](const scene::VoxelSide& v) { return 0.5f + glm::abs(v.position) * 3.0f; });
  for (size_t i = 0; weighted && i < sideCount(s); ++i) weights.push_back(uniformFloat(hashPcg(uint32_t(i))));
  const Mips got = runMips(s, radiance, directional, weights).mips;
  const int faces = directional ? 6 : 1;
  ASSERT_EQ(int(got.size), (s.voxels.resolution + 1) / 2);
  ASSERT_EQ(got.width, got.size * uint32_t(faces));
  Level level = halve(int(got.size), faces, directional, [&](int face, glm::ivec3 cell) {
    return voxelTowards(s, radiance, weights, cell, face, directional);
  });
  double occupied = 0;
  for (uint32_t l = 0; l < got.halvings(); ++l) {
    if (l > 0)
      level = halve(level.size / 2, faces, directional,
                    [&, finer = level](int face, glm::ivec3 p) mutable { return finer.at(face, p); });
    // Every level is rounded to half floats, up or down.
    const double relative = (l + 1) * 0x1p-10;
    for (int face = 0; face < faces; ++face)
      for (int i = 0; i < level.size * level.size * level.size; ++i) {
        const glm::ivec3 p(i % level.size, i / level.size % level.size, i / level.size / level.size);
        const Cell& want = level.at(face, p);
        const uint32_t x = uint32_t(p.x + face * level.size), y = uint32_t(p.y), z = uint32_t(p.z);
        const glm::vec4 color = got.at(l, x, y, z);
        for (int c = 0; c < 4; ++c)
          ASSERT_NEAR(color[c], want.color[c], relative * want.color[c] + 1e-6) << l << ' ' << i;
        ASSERT_NEAR(got.weight[got.texel(l, x, y, z)], want.weight, relative * want.weight + 1e-6);
        occupied += color.a > 0;
      }
  }
  EXPECT_GT(occupied, 100);
  // What is not half of the level before is 0.
  for (uint32_t l = got.halvings(); l < got.levels; ++l)
    for (uint32_t i = 0; i < got.widthAt(l) * got.sizeAt(l) * got.sizeAt(l); ++i)
      ASSERT_EQ(got.at(l, i % got.widthAt(l), i / got.widthAt(l) % got.sizeAt(l),
                       i / got.widthAt(l) / got.sizeAt(l)),
                glm::vec4(0));
}

scene::Scene mixedScene() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  s.materials[grey].doubleSided = true;  // thin walls with two sides
  addQuad(s, grey, {-1, -0.8f, -1}, {0, 0, 2}, {2, 0.3f, 0});
  addQuad(s, grey, {-1, -1, 0.1f}, {2, 0, 0}, {0, 1.5f, 0});
  addHollowSphere(s, addMaterial(s, glm::vec3(0.8f)), {0.2f, 0.3f, -0.3f}, 0.6f, 16, 8);
  return s;
}

TEST(Mipmap, FacesEqualTheReference) { expectReference({mixedScene(), 32}, true, true); }
TEST(Mipmap, OneVolumeEqualsTheReference) { expectReference({mixedScene(), 32}, false, true); }
TEST(Mipmap, WithoutWeightsTheyAreZero) { expectReference({mixedScene(), 16}, true, false); }

TEST(Mipmap, OtherSizesThanPowersOfTwo) {
  for (const int resolution : {24, 13, 2, 1}) {
    SCOPED_TRACE(resolution);
    const VoxelScene s(mixedScene(), resolution);
    if (resolution > 10)
      expectReference(s, true, true), expectReference(s, false, true);
    else
      EXPECT_EQ(runMips(s, radianceOf(s, [](auto&) { return glm::vec3(1); }), true).mips.size, 1u);
  }
}

// A wall of one voxel, white on its left and black on its right: from every distance the left sees white and the
// right sees black, and nothing is seen through it.
TEST(Mipmap, ThinWallsStayOpaqueAndTwoSided) {
  scene::Scene model;
  const uint32_t grey = addMaterial(model, glm::vec3(0.5f));
  const uint32_t room[6] = {grey, grey, grey, grey, grey, grey};
  addRoom(model, room, 1);
  const uint32_t thin = addMaterial(model, glm::vec3(0.5f));
  model.materials[thin].doubleSided = true;
  addQuad(model, thin, {0.02f, -1, -1}, {0, 2, 0}, {0, 0, 2});
  const VoxelScene s(model, 32);
  const auto radiance =
      radianceOf(s, [](const scene::VoxelSide& v) { return glm::vec3(v.normal.x < -0.5f ? 1.0f : 0.0f); });
  const Mips m = runMips(s, radiance, true).mips;
  for (uint32_t l = 0; l + 2 < m.levels && m.sizeAt(l) >= 4; ++l) {
    const uint32_t n = m.sizeAt(l), y = n / 2 + (n > 4), z = n / 2 - 1;
    glm::vec4 left(0), right(0);  // what is met on the way in from either side
    for (uint32_t x = n / 2 - 1; x <= n / 2; ++x) {
      right += m.at(l, x, y, z);
      left += m.at(l, n + x, y, z);
    }
    EXPECT_NEAR(left.a, 1, 0.02) << l;
    EXPECT_NEAR(right.a, 1, 0.02) << l;
    EXPECT_NEAR(left.r, 1, 0.02) << l;
    EXPECT_EQ(right.r, 0) << l;
  }
}

// Cells that become empty are cleared at all levels.
TEST(Mipmap, NothingStaysWhereSomethingWas) {
  const VoxelScene s(mixedScene(), 16);
  const auto radiance = radianceOf(s, [](auto&) { return glm::vec3(1); });
  PassTest test("mipmap");
  test.scene(s.scene);
  setVoxels(test, s.voxels);
  test.buffer("radiance", radiance, "VoxelRadiance");
  test.buffer("weights", std::vector<float>(radiance.size(), 0.5f), "VoxelWeight");
  test.run();
  const std::vector<float> first = test.floats("mips.color");
  EXPECT_GT(*std::max_element(first.begin(), first.end()), 0.5f);
  test.set("voxels.index", std::vector<uint32_t>(s.voxels.index.size(), 0));
  test.run();
  for (const float v : test.floats("mips.color")) ASSERT_EQ(v, 0);
  for (const float v : test.floats("mips.weight")) ASSERT_EQ(v, 0);
  test.set("voxels.index", s.voxels.index);
  test.run();
  EXPECT_EQ(test.floats("mips.color"), first);
}

TEST(Mipmap, NothingThere) {
  const VoxelScene s({}, 8);
  const Mips m = runMips(s, std::vector<glm::vec4>(2, glm::vec4(7)), true).mips;
  for (const float v : m.color) ASSERT_EQ(v, 0);
  for (const float v : m.weight) ASSERT_EQ(v, 0);
}

}  // namespace
}  // namespace fovea::test
