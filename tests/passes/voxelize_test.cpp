// Compares the voxeliser with plain loops on the CPU (the same voxels and sides, sums as precise as their fixed
// point) and with geometry that can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "framework/gpu/resources.h"
#include "framework/scene/device/gpu_scene.h"
#include "framework/scene/scene.h"
#include "framework/session/test_device.h"
#include "tests/references/voxel_grid.h"
#include "tests/support/shapes.h"
#include "tests/support/voxels.h"

namespace fovea::test {
namespace {

using glm::vec3;
using scene::Scene;
using scene::VoxelSide;

Scene emptyScene() {
  Scene s;
  s.cameras.emplace_back();
  return s;
}

scene::Primitive trianglePrimitive(const std::vector<vec3>& corners, uint32_t material) {
  scene::Primitive p;
  p.material = material;
  p.positions = corners;
  for (size_t i = 0; i < corners.size(); ++i) {
    p.normals.emplace_back(0, 0, 1);
    p.uvs.emplace_back(float(i % 3 == 1), float(i % 3 == 2));
    p.indices.push_back(uint32_t(i));
  }
  return p;
}

// Triangles of sizes over six decades, some beyond the last cell's width, some degenerate.
std::vector<vec3> soup(uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  auto point = [&] { return vec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<vec3> corners;
  for (uint32_t i = 0; i < count; ++i) {
    const float size = std::pow(10.0f, -3.0f * std::abs(uniform(random)) + 0.2f);
    const vec3 a = point(), u = point(), v = point();
    corners.insert(corners.end(), {a, a + size * u, a + size * (i % 17 == 0 ? 2.0f * u : v)});
  }
  return corners;
}

VoxelArrays readBack(const PassTest& test, int resolution) {
  VoxelArrays v;
  const scene::Geometry& g = test.geometry();
  v.grid = scene::voxelGrid(g.empty() ? vec3(0) : g.boundsMin, g.empty() ? vec3(0) : g.boundsMax, resolution);
  v.resolution = resolution;
  v.index = test.values<uint32_t>("voxels.index");
  v.surface = test.values<VoxelSide>("voxels.surface");
  v.info = test.values<scene::VoxelInfo>("voxels.info").at(0);
  EXPECT_EQ(test.values<uint32_t>("voxels.occupied"), occupiedBricks(v));
  return v;
}

VoxelArrays voxelize(const Scene& scene, int resolution) {
  PassTest test("voxelize");
  test.scene(scene).param("resolution", resolution).run();
  return readBack(test, resolution);
}

void expectClose(const VoxelSide& a, const VoxelSide& b, const VoxelArrays& v, size_t side) {
  const float cell = v.grid.cell;
  ASSERT_NEAR(a.area, b.area, 1e-6f * b.area + 1e-9f * cell * cell) << side;
  // Pieces of few fixed-point units have inaccurate averages.
  const float rough = 1.0f + 1e-3f * cell * cell / b.area;
  ASSERT_LT(glm::length(a.position - b.position), 2e-6f * rough * cell * float(v.resolution))
      << side << " area " << b.area;
  ASSERT_LT(glm::length(a.normal - b.normal), 1e-5f * rough) << side << " area " << b.area;
  ASSERT_LT(glm::length(a.reflectance - b.reflectance), 1e-5f * rough) << side;
  ASSERT_LT(glm::length(a.emission - b.emission), 1e-5f * rough * (1 + glm::length(b.emission))) << side;
  // As rough as the averages, and at most 2.25 times the area of the side.
  ASSERT_NEAR(a.emissionArea, b.emissionArea, 1e-5f * (b.emissionArea + 2.25e-3f * cell * cell)) << side;
  ASSERT_EQ(a.object, b.object) << side;
}

void expectEqual(const VoxelArrays& got, const VoxelArrays& want) {
  EXPECT_EQ(got.info.voxels, want.info.voxels);
  EXPECT_EQ(got.info.staticVoxels, want.info.staticVoxels);
  EXPECT_EQ(got.info.overflow, want.info.overflow);
  EXPECT_EQ(got.info.resolution, want.info.resolution);
  ASSERT_EQ(got.index, want.index);
  ASSERT_GE(got.surface.size(), want.surface.size());
  for (size_t i = 0; i < want.surface.size(); ++i) {
    ASSERT_EQ(got.surface[i].area > 0, want.surface[i].area > 0)
        << "side " << i << ": " << want.surface[i].area;
    if (want.surface[i].area > 0) {
      ASSERT_NO_FATAL_FAILURE(expectClose(got.surface[i], want.surface[i], want, i));
    }
  }
}

VoxelArrays expectAsReference(const Scene& scene, int resolution) {
  const VoxelArrays got = voxelize(scene, resolution);
  expectEqual(got, voxelizeReference(scene, scene::flatten(scene), resolution));
  return got;
}

double meshArea(const scene::Geometry& g) {
  double sum = 0;
  for (const scene::Triangle& t : g.triangles) {
    const glm::dvec3 a(g.positions[t.v[0]]), b(g.positions[t.v[1]]), c(g.positions[t.v[2]]);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

double voxelArea(const VoxelArrays& v) {
  double sum = 0;
  for (size_t i = 0; i < 2 * size_t(v.info.voxels); ++i) sum += v.surface[i].area;
  return sum;
}

TEST(Voxelize, EqualsTheReferenceOnRandomTriangles) {
  for (const int resolution : {8, 33, 64}) {
    Scene s = emptyScene();
    for (uint32_t m = 0; m < 3; ++m) {
      addMaterial(s, vec3(0.2f + 0.3f * float(m), 0.9f, 0.1f));
      s.materials[m].doubleSided = m == 1;
      s.materials[m].emission = m == 2 ? vec3(7e4f, 3, 0.01f) : vec3(0);
      addPrimitive(s, trianglePrimitive(soup(300, m + uint32_t(resolution)), m));
    }
    const VoxelArrays v = expectAsReference(s, resolution);
    EXPECT_GT(v.info.voxels, 200u);
  }
}

TEST(Voxelize, EqualsTheReferenceInTheCornellBox) {
  const Scene s = scene::builtin("cornellbox");
  const VoxelArrays v = expectAsReference(s, 64);
  const scene::Geometry g = scene::flatten(s);
  EXPECT_NEAR(voxelArea(v) / meshArea(g), 1, 1e-3);
}

// Every cell that a triangle of the soup passes through by more than a hair is present, which dense samples of
// the triangles check.
TEST(Voxelize, IsConservative) {
  Scene s = emptyScene();
  addMaterial(s, vec3(0.5f));
  const std::vector<vec3> corners = soup(200, 9);
  addPrimitive(s, trianglePrimitive(corners, 0));
  const VoxelArrays v = voxelize(s, 48);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  for (size_t t = 0; t < corners.size(); t += 3) {
    const glm::dvec3 a(corners[t]), b(corners[t + 1]), c(corners[t + 2]), n = glm::cross(b - a, c - a);
    if (glm::length(n) < 1e-6) continue;
    for (int i = 0; i < 2000; ++i) {
      const double r = std::sqrt(uniform(random)), q = uniform(random);
      const vec3 p(a * (1 - r) + b * (r * (1 - q)) + c * (r * q)), cell = v.grid.worldToVoxel(p);
      if (glm::any(glm::lessThan(glm::abs(cell - glm::round(cell)), vec3(1e-3f)))) continue;
      const uint32_t voxel = v.voxelAt(glm::ivec3(cell));
      ASSERT_GT(voxel, 0u);
      ASSERT_GT(v.surface[2 * (voxel - 1) + scene::voxelSideOf(vec3(n))].area, 0);
    }
  }
}

TEST(Voxelize, AreasSumToTheMesh) {
  for (const uint32_t count : {40u, 4000u}) {
    Scene s = emptyScene();
    addMaterial(s, vec3(0.5f));
    addPrimitive(s, trianglePrimitive(soup(count, count), 0));
    EXPECT_NEAR(voxelArea(voxelize(s, 64)) / meshArea(scene::flatten(s)), 1, 1e-4) << count;
  }
  // A finely divided sphere: thousands of triangles in a cell.
  Scene s = emptyScene();
  addHollowSphere(s, addMaterial(s, vec3(0.5f)), vec3(30, -20, 10), 1.5f, 400, 200);
  EXPECT_NEAR(voxelArea(voxelize(s, 8)) / meshArea(scene::flatten(s)), 1, 1e-4);
}

TEST(Voxelize, PlanesGivePointsOnThePlane) {
  Scene s = emptyScene();
  const vec3 u(3, 1, 0.3f), v(-0.7f, 2, 1), corner(1, 2, 3), n = glm::normalize(glm::cross(u, v));
  addQuad(s, addMaterial(s, vec3(0.25f, 0.5f, 0.75f)), corner, u, v);
  const VoxelArrays voxels = voxelize(s, 128);
  const float diagonal = glm::length(u + v);
  size_t sides = 0;
  for (size_t i = 0; i < 2 * size_t(voxels.info.voxels); ++i) {
    const VoxelSide& side = voxels.surface[i];
    if (side.area == 0) continue;
    ++sides;
    ASSERT_NEAR(glm::dot(side.position - corner, n), 0, 1e-6f * diagonal);
    // A corner of the quad may reach into a cell by a few units of fixed point.
    if (side.area < 1e-5f * voxels.grid.cell * voxels.grid.cell) continue;
    ASSERT_LT(glm::length(side.normal - n), 1e-4f);
    ASSERT_LT(glm::length(side.reflectance - vec3(0.25f, 0.5f, 0.75f)), 1e-4f);
  }
  EXPECT_EQ(sides, voxels.info.voxels);
}

TEST(Voxelize, DegenerateTrianglesHaveNoVoxels) {
  Scene s = emptyScene();
  addMaterial(s, vec3(0.5f));
  const vec3 a(0), b(1, 2, 3);
  addPrimitive(
      s, trianglePrimitive({a, a, a, a, b, b, a, b, 2.0f * b, a, vec3(1e-20f, 0, 0), vec3(0, 1e-20f, 0)}, 0));
  const VoxelArrays v = expectAsReference(s, 32);
  EXPECT_EQ(v.info.voxels, 0u);
}

TEST(Voxelize, HugeAndTinyTriangles) {
  Scene s = emptyScene();
  addMaterial(s, vec3(0.5f));
  // 160 x 160 columns in many chunks, next to triangles of a millionth of a cell.
  std::vector<vec3> corners{{0, 0, 0}, {1000, 0, 10}, {0, 1000, 500}};
  for (int i = 0; i < 50; ++i) {
    const vec3 a(900 + i, 990 - 3 * i, 40 + 0.37f * float(i));
    corners.insert(corners.end(), {a, a + vec3(1e-3f, 0, 0), a + vec3(0, 0, 1e-3f)});
  }
  addPrimitive(s, trianglePrimitive(corners, 0));
  const VoxelArrays v = expectAsReference(s, 160);
  EXPECT_NEAR(voxelArea(v) / meshArea(scene::flatten(s)), 1, 1e-4);
}

// The faces of a wall thinner than a cell are two sides, and so are those of a double-sided sheet; a single-sided
// sheet is one side.
TEST(Voxelize, ThinWallsKeepBothSides) {
  Scene s = emptyScene();
  const uint32_t red = addMaterial(s, vec3(0.8f, 0.1f, 0.1f)), blue = addMaterial(s, vec3(0.1f, 0.1f, 0.8f)),
                 both = addMaterial(s, vec3(0.5f)), one = addMaterial(s, vec3(0.5f));
  s.materials[both].doubleSided = true;
  const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  addQuad(s, red, vec3(0, 0, 0.01f), x, y);    // faces +z
  addQuad(s, blue, vec3(0, 0, -0.01f), y, x);  // faces -z
  addQuad(s, both, vec3(0, 0, 0.5f) + 0.011f * z, x, y);
  addQuad(s, one, vec3(0, 0, 0.8f), x, y);
  const VoxelArrays v = expectAsReference(s, 16);
  const uint32_t wall = v.voxelAt(glm::ivec3(v.grid.worldToVoxel(vec3(0.5f, 0.5f, 0.0f)))),
                 sheet = v.voxelAt(glm::ivec3(v.grid.worldToVoxel(vec3(0.5f, 0.5f, 0.511f)))),
                 single = v.voxelAt(glm::ivec3(v.grid.worldToVoxel(vec3(0.5f, 0.5f, 0.8f))));
  ASSERT_TRUE(wall > 0 && sheet > 0 && single > 0);
  const VoxelSide* sides = &v.surface[2 * (wall - 1)];
  EXPECT_GT(sides[0].reflectance.r, 0.79f);
  EXPECT_GT(sides[0].normal.z, 0.999f);
  EXPECT_GT(sides[1].reflectance.b, 0.79f);
  EXPECT_LT(sides[1].normal.z, -0.999f);
  EXPECT_GT(v.surface[2 * (sheet - 1)].area, 0);
  EXPECT_LT(v.surface[2 * (sheet - 1) + 1].normal.z, -0.999f);
  EXPECT_EQ(v.surface[2 * (single - 1) + 1].area, 0);
}

// A luminous panel just below a ceiling, in the same voxels: these lie on the panel and are as bright as it.
TEST(Voxelize, SidesLieWhereTheyEmit) {
  Scene s = emptyScene();
  const uint32_t plaster = addMaterial(s, vec3(0.8f)), panel = addMaterial(s, vec3(0.2f));
  s.materials[panel].emission = vec3(2, 4, 6);
  const vec3 x(1, 0, 0), y(0, 1, 0);
  addQuad(s, plaster, vec3(0, 0, 0), x, y);
  addQuad(s, plaster, vec3(0, 0, 0.55f), y, x);
  addQuad(s, panel, vec3(0, 0, 0.54f), y, x);
  const VoxelArrays v = expectAsReference(s, 16);
  const uint32_t voxel = v.voxelAt(glm::ivec3(v.grid.worldToVoxel(vec3(0.5f, 0.5f, 0.545f))));
  ASSERT_GT(voxel, 0u);
  const VoxelSide& below = v.surface[2 * (voxel - 1) + 1];
  EXPECT_NEAR(below.position.z, 0.54f, 1e-4f);
  EXPECT_LT(glm::length(below.reflectance - vec3(0.5f)), 1e-4f);
  EXPECT_LT(glm::length(below.emission - vec3(2, 4, 6)), 1e-4f);
}

TEST(Voxelize, TexturesAndAlphaMasks) {
  Scene s = emptyScene();
  scene::Texture texture;
  texture.width = 8, texture.height = 8;
  for (int i = 0; i < 64; ++i) {
    const bool hole = i % 8 < 4;
    for (const int c : {10 + 3 * i, 255 - 2 * i, hole ? 255 : 40, hole ? 0 : 255})
      texture.rgba.push_back(uint8_t(c));
  }
  s.textures.push_back(texture);
  const uint32_t plain = addMaterial(s, vec3(0.9f)), masked = addMaterial(s, vec3(0.7f));
  for (const uint32_t m : {plain, masked}) {
    s.materials[m].baseColorTexture.texture = 0;
    s.materials[m].baseColorTexture.wrapU = s.materials[m].baseColorTexture.wrapV = scene::Wrap::Clamp;
  }
  s.materials[masked].masked = true;
  addQuad(s, plain, vec3(0, 0, 0.1f), vec3(2, 0, 0.2f), vec3(0, 2, 0));
  addQuad(s, masked, vec3(0, 0, 1.1f), vec3(2, 0, 0.2f), vec3(0, 2, 0));
  const VoxelArrays v = expectAsReference(s, 40);
  const double quad = 2.0 * std::sqrt(4.04);
  EXPECT_NEAR(voxelArea(v) / quad, 1.5, 0.05);  // half of the masked one
}

TEST(Voxelize, EmptyScene) {
  PassTest test("voxelize");
  test.scene(emptyScene()).param("resolution", 16).run(2);
  const VoxelArrays v = readBack(test, 16);
  EXPECT_EQ(v.info.voxels, 0u);
  EXPECT_EQ(v.info.resolution, 16u);
  EXPECT_EQ(v.index, std::vector<uint32_t>(16 * 16 * 16));
}

TEST(Voxelize, OverflowIsCountedAndLeftOut) {
  Scene s = emptyScene();
  addMaterial(s, vec3(0.5f));
  addPrimitive(s, trianglePrimitive(soup(400, 5), 0));
  const VoxelArrays want = voxelizeReference(s, scene::flatten(s), 32);
  ASSERT_GT(want.info.voxels, 1024u);
  PassTest test("voxelize");
  test.scene(s).param("resolution", 32).param("capacity", 1).run(2);
  const VoxelArrays got = readBack(test, 32);
  EXPECT_EQ(got.info.voxels, 1024u);
  EXPECT_EQ(got.info.overflow, want.info.voxels - 1024u);
  EXPECT_EQ(test.counter("overflow"), double(got.info.overflow));
  EXPECT_EQ(test.counter("voxels"), 1024);
  ASSERT_EQ(got.surface.size(), 2048u);
  for (size_t i = 0; i < want.index.size(); ++i)
    ASSERT_EQ(got.index[i], want.index[i] <= 1024 ? want.index[i] : 0u);
  for (size_t i = 0; i < 2048; ++i)
    ASSERT_NO_FATAL_FAILURE(expectClose(got.surface[i], want.surface[i], want, i));
}

// A soup that moves by keys of one frame each: into the static geometry, out beyond the opposite corner of the grid,
// away, and back.
Scene movingScene(uint32_t objects) {
  Scene s = emptyScene();
  const uint32_t grey = addMaterial(s, vec3(0.5f)), red = addMaterial(s, vec3(0.9f, 0.1f, 0.1f));
  addQuad(s, grey, vec3(-2, -1, -2), vec3(0, 0, 4), vec3(4, 0, 0));
  addQuad(s, grey, vec3(-2, -1, -2), vec3(4, 0, 0), vec3(0, 3, 0));
  for (uint32_t i = 0; i < objects; ++i) {
    std::vector<vec3> corners = soup(60, 40 + i);
    for (vec3& c : corners) c *= 0.3f;
    addPrimitive(s, trianglePrimitive(corners, red));
    scene::Mover mover;
    mover.node = uint32_t(s.nodes.size() - 1);
    mover.smooth = false;
    s.nodes[mover.node].dynamic = true;
    const vec3 places[] = {{0, 0, 0}, {-1, -1, -1}, {1.5f, 1.5f, 1.5f},
                           {0, 0, 0}, {0, 0, 0},    {-1.5f, -0.9f, 0}};
    for (int k = 0; k < 6; ++k) {
      scene::MotionKey key;
      key.time = float(k) / 42.0f - 1e-4f;
      key.translation = places[(k + 4 * int(i)) % 6] + 0.1f * float(i);
      key.visible = k != 3 && !(i == 1 && k == 4);
      mover.keys.push_back(key);
    }
    s.movers.push_back(mover);
  }
  return s;
}

TEST(Voxelize, DynamicObjectsMoveAppearAndDisappear) {
  const Scene s = movingScene(2);
  PassTest test("voxelize");
  test.scene(s).param("resolution", 40);
  uint32_t hidden = 0, gone = 0;
  for (int frame = 0; frame < 7; ++frame) {
    test.run();
    const VoxelArrays got = readBack(test, 40), want = voxelizeReference(s, test.geometry(), 40);
    ASSERT_NO_FATAL_FAILURE(expectEqual(got, want)) << "frame " << frame;
    EXPECT_EQ(test.counter("voxels"), got.info.voxels);
    EXPECT_EQ(test.counter("static_voxels"), want.info.staticVoxels);
    std::vector<bool> shown(got.info.staticVoxels);
    for (const uint32_t i : got.index)
      if (i > 0 && i <= got.info.staticVoxels) shown[i - 1] = true;
    for (const bool b : shown) hidden += !b;
    gone += got.info.voxels == got.info.staticVoxels;
    for (size_t i = 2 * size_t(got.info.voxels); i < got.surface.size(); ++i)
      ASSERT_EQ(got.surface[i].area, 0);
  }
  EXPECT_GT(hidden, 10u);  // dynamic voxels in cells of static ones
  EXPECT_EQ(gone, 1u);     // the frame without any object
}

// The voxels of a scene in which every third triangle is hidden from voxels are those of the scene that has only
// the other triangles.
TEST(Voxelize, TrianglesThatAreCoarserForLight) {
  Scene s = movingScene(2), coarse = s;
  for (size_t m = 0; m < s.meshes.size(); ++m)
    for (size_t n = 0; n < s.meshes[m].primitives.size(); ++n) {
      std::vector<uint32_t>& kept = coarse.meshes[m].primitives[n].indices;
      if (kept.size() < 9) continue;
      std::vector<uint32_t> list;
      for (size_t i = 0; i < kept.size(); ++i)
        if (i / 3 % 3 != 2) list.push_back(kept[i]);
      kept = s.meshes[m].primitives[n].lightIndices = list;
    }
  PassTest test("voxelize");
  test.scene(s).param("resolution", 40);
  scene::Geometry g = scene::flatten(coarse);
  ASSERT_LT(g.triangles.size(), scene::flatten(s).triangles.size());
  for (int frame = 0; frame < 3; ++frame) {
    test.run();
    g.positions = test.geometry().positions;
    ASSERT_NO_FATAL_FAILURE(expectEqual(readBack(test, 40), voxelizeReference(coarse, g, 40))) << frame;
  }
}

TEST(Voxelize, OnlyDynamicObjects) {
  Scene s = movingScene(1);
  s.nodes.erase(s.nodes.begin(), s.nodes.begin() + 2);
  s.movers[0].node = 0;
  PassTest test("voxelize");
  test.scene(s).param("resolution", 24);
  for (int frame = 0; frame < 5; ++frame) {
    test.run();
    const VoxelArrays got = readBack(test, 24);
    ASSERT_NO_FATAL_FAILURE(expectEqual(got, voxelizeReference(s, test.geometry(), 24))) << "frame " << frame;
    EXPECT_EQ(got.info.staticVoxels, 0u);
  }
}

// What finds no room leaves the static voxel of its cell visible.
TEST(Voxelize, DynamicOverflow) {
  const Scene s = movingScene(2);
  PassTest test("voxelize");
  test.scene(s).param("resolution", 40).param("capacity", 2);
  for (int frame = 0; frame < 3; ++frame) {
    test.run();
    const VoxelArrays got = readBack(test, 40), want = voxelizeReference(s, test.geometry(), 40);
    const uint32_t room = 2 * 40 * 40;
    ASSERT_LE(want.info.staticVoxels, room);
    EXPECT_EQ(got.info.voxels, std::min(room, want.info.voxels));
    EXPECT_EQ(got.info.overflow, want.info.voxels - got.info.voxels);
    EXPECT_EQ(test.counter("overflow"), got.info.overflow);
    for (size_t i = 0; i < want.index.size(); ++i)
      if (want.index[i] <= room) {
        ASSERT_EQ(got.index[i], want.index[i]);
      } else {
        ASSERT_LE(got.index[i], got.info.staticVoxels);
      }
  }
}

// More voxels than there is room for sums at once (2^19): sheets that each fill a layer of cells.
TEST(Voxelize, SumsInBatches) {
  Scene s = emptyScene();
  const uint32_t material = addMaterial(s, vec3(0.2f, 0.4f, 0.6f));
  for (int i = 0; i < 15; ++i)
    addQuad(s, material, vec3(0, 0, 0.0637f * float(i)), vec3(1, 0, 0), vec3(0, 1, 0));
  PassTest test("voxelize");
  test.scene(s).param("resolution", 192).param("capacity", 512).run();
  const VoxelArrays v = readBack(test, 192);
  EXPECT_EQ(v.info.voxels, 15u * 192u * 192u);
  EXPECT_EQ(v.info.overflow, 0u);
  ASSERT_EQ(v.surface.size(), 2u << 20);
  EXPECT_NEAR(voxelArea(v), 15, 1e-3);
  for (size_t i = 0; i < 2 * size_t(v.info.voxels); i += 2) {
    ASSERT_GT(v.surface[i].area, 0) << i;
    ASSERT_EQ(v.surface[i + 1].area, 0) << i;
    ASSERT_LT(glm::length(v.surface[i].reflectance - vec3(0.2f, 0.4f, 0.6f)), 1e-4f) << i;
  }
}

TEST(Voxelize, StillScenesCostNothingLater) {
  Scene s = emptyScene();
  addMaterial(s, vec3(0.5f));
  addPrimitive(s, trianglePrimitive(soup(500, 8), 0));
  PassTest test("voxelize");
  test.scene(s).param("resolution", 32).run();
  const VoxelArrays first = readBack(test, 32);
  test.beforeFrame([](PassTest&, scene::Frame& frame) { frame.cameraCut = frame.index == 2; });
  for (int frame = 1; frame < 4; ++frame) {
    test.run();
    EXPECT_EQ(readBack(test, 32).index, first.index);
    EXPECT_EQ(test.counter("voxels"), first.info.voxels);
  }
}

TEST(Voxelize, IsTheSameEveryTime) {
  Scene s = emptyScene();
  addMaterial(s, vec3(0.5f));
  addPrimitive(s, trianglePrimitive(soup(500, 8), 0));
  const VoxelArrays a = voxelize(s, 32), b = voxelize(s, 32);
  EXPECT_EQ(a.index, b.index);
  const size_t bytes = 2 * a.info.voxels * sizeof(VoxelSide);
  EXPECT_EQ(std::memcmp(a.surface.data(), b.surface.data(), bytes), 0);
}

}  // namespace
}  // namespace fovea::test
