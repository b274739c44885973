// Tests flatten(): world space, static before dynamic geometry, and front faces that remain front faces.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using testing::HasSubstr;

// One triangle in the plane z = 0, facing +Z.
Scene triangleScene() {
  Scene s;
  s.name = "test";
  s.materials.emplace_back();
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.uvs = {{0, 0}, {1, 0}, {0, 1}};
  p.indices = {0, 1, 2};
  s.meshes.push_back({"tri", {p}});
  return s;
}

Node meshNode(uint32_t parent = kNoIndex) {
  Node n;
  n.mesh = 0;
  n.parent = parent;
  return n;
}

glm::vec3 geometricNormal(const Geometry& g, size_t i) {
  const Triangle& t = g.triangles[i];
  return glm::normalize(
      glm::cross(g.positions[t.v[1]] - g.positions[t.v[0]], g.positions[t.v[2]] - g.positions[t.v[0]]));
}

// Emissive triangles are listed in their order, whether they move or not.
TEST(Flatten, ListsWhatEmits) {
  Scene s = triangleScene();
  s.materials.resize(2);
  s.materials[1].emission = {0, 1, 0};
  s.meshes.push_back(s.meshes[0]);
  s.meshes[1].primitives[0].material = 1;
  for (const uint32_t mesh : {1u, 0u, 1u, 1u}) {
    s.nodes.push_back(meshNode());
    s.nodes.back().mesh = mesh;
  }
  s.nodes[2].dynamic = true;
  EXPECT_EQ(flatten(s).emissive, (std::vector<uint32_t>{0, 2, 3}));
  s.materials[1].emission = {};
  EXPECT_TRUE(flatten(s).emissive.empty());
}

// A tetrahedron with three perpendicular edges of 1, 2 and 4 m. Its bounds have the volume V = 8 m^3, and its four faces
// the area S, so that the mean free path is 4 V / S.
TEST(Flatten, MeanFreePath) {
  Scene s = triangleScene();
  EXPECT_EQ(flatten(s).meanFreePath, 0);
  Primitive& p = s.meshes[0].primitives[0];
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}};
  p.normals.assign(4, {0, 0, 1});
  p.uvs.assign(4, glm::vec2(0));
  p.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 2, 3};
  s.nodes.push_back(meshNode());
  const double surface = 1 + 4 + 2 + std::sqrt(1.0 + 16 + 4);  // de Gua's theorem
  EXPECT_NEAR(flatten(s).meanFreePath, 4 * 8 / surface, 1e-5);
  s.nodes[0].scale = glm::vec3(0.1f);
  EXPECT_NEAR(flatten(s).meanFreePath, 0.4 * 8 / surface, 1e-6);
}

TEST(Flatten, AppliesTheWholeChainOfTransforms) {
  Scene s = triangleScene();
  Node root;
  root.translation = {10, 0, 0};
  root.rotation = glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 1, 0));
  s.nodes.push_back(root);
  Node child = meshNode(0);
  child.scale = {2, 3, 1};
  child.translation = {0, 1, 0};
  s.nodes.push_back(child);
  const Geometry g = flatten(s);
  ASSERT_EQ(g.positions.size(), 3u);
  // +X of the root points to -Z.
  EXPECT_LT(glm::distance(g.positions[0], glm::vec3(10, 1, 0)), 1e-5f);
  EXPECT_LT(glm::distance(g.positions[1], glm::vec3(10, 1, -2)), 1e-5f);
  EXPECT_LT(glm::distance(g.positions[2], glm::vec3(10, 4, 0)), 1e-5f);
  EXPECT_LT(glm::distance(g.normals[0], glm::vec3(1, 0, 0)), 1e-5f);
  EXPECT_LT(glm::distance(g.boundsMin, glm::vec3(10, 1, -2)), 1e-5f);
  EXPECT_LT(glm::distance(g.boundsMax, glm::vec3(10, 4, 0)), 1e-5f);
}

TEST(Flatten, MirrorsFlipTheWinding) {
  Scene s = triangleScene();
  for (const glm::vec3 scale :
       {glm::vec3(-1, 1, 1), glm::vec3(1, 1, -1), glm::vec3(-1, -1, 1), glm::vec3(-2, -1, -3)}) {
    s.nodes = {meshNode()};
    s.nodes[0].scale = scale;
    const Geometry g = flatten(s);
    // The front of the mirrored triangle is where the mirrored normal points.
    const glm::vec3 expected(0, 0, scale.z > 0 ? 1 : -1);
    EXPECT_LT(glm::distance(g.normals[0], expected), 1e-6f) << scale.x << scale.y << scale.z;
    EXPECT_LT(glm::distance(geometricNormal(g, 0), expected), 1e-6f) << scale.x << scale.y << scale.z;
  }
}

TEST(Flatten, NormalsGoByTheInverseTranspose) {
  Scene s = triangleScene();
  // The plane x + z = const: its normal under a stretch of x by 4 is (1/4, 0, 1), not (4, 0, 1).
  s.meshes[0].primitives[0].positions = {{0, 0, 0}, {1, 0, -1}, {0, 1, 0}};
  s.meshes[0].primitives[0].normals.assign(3, glm::normalize(glm::vec3(1, 0, 1)));
  s.nodes = {meshNode()};
  s.nodes[0].scale = {4, 1, 1};
  const Geometry g = flatten(s);
  EXPECT_LT(glm::distance(g.normals[0], glm::normalize(glm::vec3(0.25f, 0, 1))), 1e-6f);
  EXPECT_LT(glm::distance(g.normals[0], geometricNormal(g, 0)), 1e-6f);
  // The node has a shear, given as a matrix.
  glm::mat4 shear(1.0f);
  shear[1][2] = 2.0f;
  s.nodes[0].matrix = shear;
  const Geometry h = flatten(s);
  EXPECT_LT(glm::distance(h.normals[0], geometricNormal(h, 0)), 1e-6f);
}

TEST(Flatten, StaticFirstThenOneObjectPerMovingNode) {
  Scene s = triangleScene();
  s.nodes = {meshNode(), meshNode(), meshNode(), meshNode(1)};
  s.nodes[1].dynamic = true;
  s.nodes[1].name = "mover";
  const Geometry g = flatten(s);
  ASSERT_EQ(g.objects.size(), 3u);  // static, the mover, and what hangs on it
  EXPECT_EQ(g.staticTriangles, 2u);
  EXPECT_FALSE(g.objects[0].dynamic);
  EXPECT_EQ(g.objects[0].triangleCount, 2u);
  EXPECT_EQ(g.objects[1].name, "mover");
  EXPECT_EQ(g.objects[1].node, 1u);
  EXPECT_EQ(g.objects[1].firstTriangle, 2u);
  EXPECT_EQ(g.objects[1].firstVertex, 6u);
  EXPECT_EQ(g.objects[1].vertexCount, 3u);
  EXPECT_TRUE(g.objects[2].dynamic);
  EXPECT_EQ(g.objects[2].node, 3u);
  for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(g.triangles[i].object(), i < 2 ? 0u : i - 1);
}

// A separate list for voxels and VPL maps exists only where something is coarser for them; it holds all that they see.
TEST(Flatten, WhatLightSeesIsAListOfItsOwnWhereItIsCoarser) {
  Scene s = triangleScene();
  s.nodes = {meshNode(), meshNode()};
  s.nodes[1].dynamic = true;
  Primitive& p = s.meshes[0].primitives[0];
  p.positions.push_back({1, 1, 0});
  p.normals.push_back(p.normals[0]);
  p.uvs.push_back(p.uvs[0]);
  p.indices = {0, 1, 3, 0, 3, 2};
  Geometry g = flatten(s);
  EXPECT_TRUE(g.lightTriangles.empty());
  EXPECT_EQ(g.light().first, 0u);
  EXPECT_EQ(g.light().firstMoving, 2u);
  EXPECT_EQ(g.light().end, 4u);
  p.lightIndices = {0, 1, 2};
  g = flatten(s);
  EXPECT_EQ(g.triangles.size(), 4u) << "the picture's stay";
  EXPECT_EQ(g.light().first, 4u);
  EXPECT_EQ(g.light().firstMoving, 5u);
  EXPECT_EQ(g.light().end, 6u);
  EXPECT_EQ(g.triangle(4).v[2], 2u);
  EXPECT_EQ(g.triangle(5).v[2], 6u);
  EXPECT_EQ(g.triangle(5).object(), 1u);
  EXPECT_EQ(&g.triangle(3), &g.triangles[3]);
}

TEST(Flatten, SingularTransformsKeepUnitNormals) {
  Scene s = triangleScene();
  s.nodes = {meshNode(), meshNode()};
  s.nodes[0].scale = {1, 1, 0};
  s.nodes[1].scale = {0, 0, 0};
  const Geometry g = flatten(s);
  for (const glm::vec3& n : g.normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-6f);
  EXPECT_LT(glm::distance(g.normals[0], glm::vec3(0, 0, 1)), 1e-6f);
}

TEST(Flatten, PlacesThatAreNotFiniteNameTheNode) {
  Scene s = triangleScene();
  s.nodes = {meshNode(), meshNode(0)};
  s.nodes[0].scale = glm::vec3(3e38f);
  s.nodes[1].scale = glm::vec3(3e38f);
  s.nodes[1].name = "far away";
  EXPECT_THAT(test::errorOf([&] { flatten(s); }), HasSubstr("far away"));
}

TEST(Flatten, LimitsAreNamed) {
  Scene s = triangleScene();
  s.nodes = {meshNode()};
  s.materials.resize(70000);
  EXPECT_THAT(test::errorOf([&] { flatten(s); }), HasSubstr("65535"));
  s.materials.resize(1);
  s.nodes.assign(70000, meshNode());
  for (Node& n : s.nodes) n.dynamic = true;
  EXPECT_THAT(test::errorOf([&] { flatten(s); }), HasSubstr("65535"));
  // A thousand nodes that each show a mesh of 100,000 triangles.
  s.meshes[0].primitives[0].indices.assign(300000, 0);
  s.nodes.assign(1000, meshNode());
  EXPECT_THAT(test::errorOf([&] { flatten(s); }), HasSubstr("100000000 triangles"));
}

TEST(SceneHash, FollowsEveryPartOfTheContentButNotNames) {
  Scene s = triangleScene();
  s.nodes = {meshNode()};
  s.cameras.emplace_back();
  s.lights.emplace_back();
  const uint64_t h = contentHash(s);
  const auto changed = [&](auto&& change) {
    Scene copy = s;
    change(copy);
    return contentHash(copy) != h;
  };
  EXPECT_TRUE(changed([](Scene& c) { c.meshes[0].primitives[0].positions[1].x = 2; }));
  EXPECT_TRUE(changed([](Scene& c) { c.meshes[0].primitives[0].indices = {0, 2, 1}; }));
  EXPECT_TRUE(changed([](Scene& c) { c.meshes[0].primitives[0].lightIndices = {0, 1, 2}; }));
  EXPECT_TRUE(changed([](Scene& c) { c.materials[0].baseColor.g = 0.5f; }));
  EXPECT_TRUE(changed([](Scene& c) { c.materials[0].masked = true; }));
  EXPECT_TRUE(changed([](Scene& c) { c.nodes[0].translation.y = 1; }));
  EXPECT_TRUE(changed([](Scene& c) { c.lights[0].intensity = 2; }));
  EXPECT_TRUE(changed([](Scene& c) { c.cameras[0].verticalFov = 1; }));
  EXPECT_TRUE(changed([](Scene& c) { c.exposure = 2; }));
  EXPECT_TRUE(changed([](Scene& c) { c.gaze.push_back({0, {0.1f, 0.2f}, true}); }));
  EXPECT_TRUE(changed([](Scene& c) { c.textures.push_back({"t", 1, 1, true, {1, 2, 3, 4}}); }));
  EXPECT_FALSE(changed([](Scene& c) { c.name = c.materials[0].name = c.nodes[0].name = "other"; }));
}

}  // namespace
}  // namespace fovea::scene
