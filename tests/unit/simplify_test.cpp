#include "framework/scene/device/simplify.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::scene {
namespace {

// A flat grid of n x n cells in the plane y = 0 from 0 to 1, with two triangles per cell.
Primitive grid(uint32_t n, uint32_t material) {
  Primitive p;
  for (uint32_t z = 0; z <= n; ++z)
    for (uint32_t x = 0; x <= n; ++x) p.positions.push_back({float(x) / float(n), 0, float(z) / float(n)});
  p.normals.assign(p.positions.size(), {0, 1, 0});
  p.uvs.assign(p.positions.size(), {0, 0});
  for (uint32_t z = 0; z < n; ++z)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t i = z * (n + 1) + x;
      p.indices.insert(p.indices.end(), {i, i + n + 1, i + 1, i + 1, i + n + 1, i + n + 2});
    }
  p.material = material;
  return p;
}

Scene gridScene(bool withMask) {
  Scene s;
  s.materials.resize(2);
  s.materials[1].masked = true;
  s.meshes.push_back({"opaque", {grid(20, 0)}});
  s.nodes.emplace_back().mesh = 0;
  if (withMask) {
    s.meshes.push_back({"leaves", {grid(3, 1)}});
    Node& node = s.nodes.emplace_back();
    node.mesh = 1;
    node.translation = {0, 1, 0};
  }
  return s;
}

double area(const SimplifiedMesh& mesh) {
  double sum = 0;
  for (size_t i = 0; i < mesh.corners.size(); i += 3) {
    const glm::dvec3 a(mesh.corners[i]), b(mesh.corners[i + 1]), c(mesh.corners[i + 2]);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

TEST(Simplify, FlatSurfaceLosesTrianglesButNoArea) {
  const Scene s = gridScene(false);
  const Geometry g = flatten(s);
  const SimplifiedMesh mesh = simplify(s, g, 0.1f);
  EXPECT_EQ(mesh.sourceTriangles, 800u);
  EXPECT_LE(mesh.triangles(), 120u);
  EXPECT_GE(mesh.triangles(), 2u);
  EXPECT_NEAR(area(mesh), 1.0, 1e-4);
  EXPECT_LT(mesh.error, 1e-4f);
}

TEST(Simplify, RatioOneKeepsEveryTriangleAsItIs) {
  const Scene s = gridScene(true);
  const Geometry g = flatten(s);
  const SimplifiedMesh mesh = simplify(s, g, 1.0f);
  EXPECT_EQ(mesh.triangles(), g.triangles.size());
  EXPECT_EQ(mesh.error, 0.0f);
  EXPECT_NEAR(area(mesh), 2.0, 1e-4);
}

TEST(Simplify, MaskedTrianglesStayAndNameTheirOriginal) {
  const Scene s = gridScene(true);
  const Geometry g = flatten(s);
  const SimplifiedMesh mesh = simplify(s, g, 0.05f);
  uint32_t named = 0;
  for (uint32_t i = 0; i < mesh.triangles(); ++i) {
    const float w = mesh.corners[3 * i].w;
    if (w == 0) continue;
    ++named;
    const Triangle& t = g.triangles[uint32_t(w) - 1];
    EXPECT_EQ(t.material(), 1u);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(glm::vec3(mesh.corners[3 * i + k]), g.positions[t.v[k]]);
  }
  EXPECT_EQ(named, 18u);
}

TEST(Simplify, NothingToDo) {
  Scene s;
  s.materials.emplace_back();
  EXPECT_EQ(simplify(s, flatten(s), 0.5f).triangles(), 0u);
}

}  // namespace
}  // namespace fovea::scene
