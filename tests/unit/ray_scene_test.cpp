#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "framework/base/random.h"
#include "framework/scene/materials/passage.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using test::addMaterial;
using test::addQuad;

// Moeller and Trumbore's test over all triangles, in double precision.
RayHit bruteForce(const Geometry& g, const Ray& ray) {
  RayHit best;
  double nearest = ray.far;
  for (uint32_t t = 0; t < g.triangles.size(); ++t) {
    const glm::dvec3 a(g.positions[g.triangles[t].v[0]]), b(g.positions[g.triangles[t].v[1]]),
        c(g.positions[g.triangles[t].v[2]]), o(ray.origin), d(ray.direction);
    const glm::dvec3 p = glm::cross(d, c - a);
    const double det = glm::dot(b - a, p);
    if (det == 0) continue;
    const double u = glm::dot(o - a, p) / det;
    const glm::dvec3 q = glm::cross(o - a, b - a);
    const double v = glm::dot(d, q) / det, distance = glm::dot(c - a, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || distance <= ray.near || distance >= nearest) continue;
    nearest = distance;
    best = {t, float(distance), float(u), float(v)};
  }
  return best;
}

glm::vec3 randomVector(uint32_t i, uint32_t what) {
  const auto u = [&](uint32_t k) { return 2 * uniformFloat(randomStream(1, what, k, i)) - 1; };
  return {u(0), u(1), u(2)};
}

TEST(RayScene, NearestHitEqualsBruteForce) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  for (uint32_t i = 0; i < 60; ++i)
    addQuad(s, 0, 3.0f * randomVector(i, 0), randomVector(i, 1), randomVector(i, 2));
  const Geometry g = flatten(s);
  const RayScene rays(s, g);
  int hits = 0, disagreements = 0;
  for (uint32_t i = 0; i < 5000; ++i) {
    const Ray ray{4.0f * randomVector(i, 3), randomVector(i, 4), 0, i % 3 == 0 ? 2.0f : 1e30f};
    const RayHit expected = bruteForce(g, ray), hit = rays.intersect(ray);
    EXPECT_EQ(bool(hit), rays.occluded(ray));
    if (hit.triangle != expected.triangle) {  // possible only at edges and where two triangles cross
      ++disagreements;
      continue;
    }
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit.distance, expected.distance, 1e-4f * expected.distance + 1e-5f);
    const SurfaceHit surface = surfaceAt(g, hit);
    EXPECT_LT(glm::length(surface.position - (ray.origin + hit.distance * ray.direction)), 1e-4f);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LE(disagreements, 3);
}

TEST(RayScene, SurfaceAttributes) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addMaterial(s, glm::vec3(0.6f));
  addQuad(s, 1, {0, 0, 0}, {2, 0, 0}, {0, 4, 0});  // front: +z
  for (glm::vec3& n : s.meshes[0].primitives[0].normals) n = glm::normalize(glm::vec3(1, 0, 1));
  const Geometry g = flatten(s);
  const RayScene rays(s, g);
  EXPECT_DOUBLE_EQ(rays.surfaceArea(), 8);
  const RayHit hit = rays.intersect({{0.5f, 3, 10}, {0, 0, -2}});
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit.distance, 5);
  const SurfaceHit surface = surfaceAt(g, hit);
  EXPECT_NEAR(surface.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(surface.uv.y, 0.75f, 1e-6f);
  EXPECT_EQ(surface.geometricNormal, glm::vec3(0, 0, 1));
  EXPECT_NEAR(surface.shadingNormal.x, std::sqrt(0.5f), 1e-6f);
  EXPECT_EQ(surface.material, 1u);
}

// A checkerboard mask over a floor: rays pass where its alpha is 0, and only there.
TEST(RayScene, MaskedHolesLetRaysThrough) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  Material masked;
  masked.masked = true;
  masked.baseColorTexture.texture = 0;
  masked.baseColorTexture.wrapU = masked.baseColorTexture.wrapV = Wrap::Clamp;
  s.materials.push_back(masked);
  Texture t;
  t.width = t.height = 2;
  for (int i = 0; i < 4; ++i)
    t.rgba.insert(t.rgba.end(), {255, 255, 255, uint8_t(i == 0 || i == 3 ? 255 : 0)});
  s.textures.push_back(t);
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  addQuad(s, 1, {0, 1, 0}, {1, 0, 0}, {0, 0, -1});
  const Geometry g = flatten(s);
  const RayScene rays(s, g);
  for (uint32_t i = 0; i < 1000; ++i) {
    const glm::vec2 p = 0.5f + 0.49f * glm::vec2(randomVector(i, 0));
    const float alpha = reflectance(s, s.materials[1], p).a;
    const Ray down{{p.x, 2, -p.y}, {0, -1, 0}};
    const RayHit hit = rays.intersect(down);
    ASSERT_TRUE(hit);
    if (std::abs(alpha - 0.5f) > 0.01f) {
      EXPECT_NEAR(hit.distance, alpha > 0.5f ? 1.0f : 2.0f, 1e-5f);
    }
    EXPECT_EQ(rays.occluded({down.origin, down.direction, 0, 1.5f}), hit.distance < 1.5f);
  }
}

// Two layers of a material.
Scene layers(const Material& material) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  s.materials.push_back(material);
  for (const float y : {1.0f, 1.5f}) addQuad(s, 1, {0, y, 0}, {1, 0, 0}, {0, 0, -1});
  return s;
}

// The shares of rays at 45 degrees that meet the upper layer and the lower one.
std::array<double, 2> met(const RayScene& rays) {
  constexpr uint32_t kRays = 20000;
  std::array<double, 2> share{};
  for (uint32_t i = 0; i < kRays; ++i) {
    const glm::vec2 p = 0.25f + 0.2f * glm::vec2(randomVector(i, 0));
    const Ray ray{{p.x - 0.5f, 2, -p.y}, glm::vec3(1, -1, 0), 0, 3, hashPcg(i)};
    const RayHit hit = rays.intersect(ray);
    EXPECT_EQ(rays.intersect(ray).triangle, hit.triangle);
    EXPECT_EQ(rays.occluded({ray.origin, ray.direction, 0, 1.5f, ray.key}), hit && hit.distance < 1.5f);
    if (!hit) continue;
    share[hit.distance < 0.75f ? 0 : 1] += 1.0 / kRays;
  }
  return share;
}

// Each layer stops its share of the rays whatever the other does. The tolerance is four standard deviations.
TEST(RayScene, RaysPassWhatLetsLightThroughAtRandom) {
  Material veil;
  veil.masked = veil.blended = true;
  veil.baseColor.a = 0.3f;
  const Scene s = layers(veil);
  const Geometry g = flatten(s);
  const auto random = met(RayScene(s, g, Passing::Random));
  EXPECT_NEAR(random[0], 0.3, 0.013);
  EXPECT_NEAR(random[1], 0.7 * 0.3, 0.012);
  EXPECT_DOUBLE_EQ(met(RayScene(s, g))[1] + met(RayScene(s, g))[0], 0);  // 0.3 is below the cutoff
  EXPECT_NEAR(met(RayScene(s, g, Passing::Met))[0], 1, 1e-9);

  Material glass;
  glass.transmission = 0.8f;
  glass.roughness = 0.2f;
  glass.baseColor = {0.9f, 0.6f, 0.3f, 1};
  const Scene t = layers(glass);
  const float passes = passage(t, glass, {0, 0}, std::sqrt(0.5f));
  EXPECT_NEAR(passes, 0.8f * 0.6f * 0.95f, 0.01f);
  const auto panes = met(RayScene(t, g, Passing::Random));
  EXPECT_NEAR(panes[0], 1 - passes, 0.014);
  EXPECT_NEAR(panes[1], passes * (1 - passes), 0.014);
  EXPECT_NEAR(met(RayScene(t, g))[0], 1, 1e-9);
}

TEST(RayScene, CacheKnowsWaysOfPassing) {
  Scene s = layers({});
  const Geometry g = flatten(s);
  EXPECT_EQ(RayScene::cached(s, g), RayScene::cached(s, g, Passing::Random));  // nothing lets light through
  s.materials[1].masked = s.materials[1].blended = true;
  EXPECT_NE(RayScene::cached(s, g), RayScene::cached(s, g, Passing::Random));
  EXPECT_NE(RayScene::cached(s, g, Passing::Met), RayScene::cached(s, g, Passing::Random));
}

TEST(RayScene, EmptySceneIsHitByNothing) {
  const Scene s;
  const Geometry g;
  const RayScene rays(s, g);
  EXPECT_FALSE(rays.intersect({{0, 0, 0}, {0, 0, 1}}));
  EXPECT_FALSE(rays.occluded({{0, 0, 0}, {0, 0, 1}}));
}

TEST(RayScene, CacheFollowsTheContentNotTheAddress) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Geometry g = flatten(s);
  const auto first = RayScene::cached(s, g);
  const Geometry copy = g;
  EXPECT_EQ(first, RayScene::cached(s, copy));
  for (glm::vec3& p : g.positions) p.z -= 1;  // in place: same address, other content
  const auto moved = RayScene::cached(s, g);
  EXPECT_NE(first, moved);
  EXPECT_FLOAT_EQ(moved->intersect({{0.5f, 0.5f, 1}, {0, 0, -1}}).distance, 2);
  EXPECT_EQ(first, RayScene::cached(s, copy));  // the two most recent are kept
}

// Static triangles behind and in front of moving ones, with a mask among both.
TEST(RayScene, MovingPartsAreFoundWhereTheyAre) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  Material masked;
  masked.masked = true;
  masked.baseColor.a = 0;
  s.materials.push_back(masked);
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  addQuad(s, 0, {0, 0, 2}, {0.5f, 0, 0}, {0, 1, 0});
  addQuad(s, 0, {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  addQuad(s, 1, {0, 0, 3}, {1, 0, 0}, {0, 1, 0});
  s.nodes[2].dynamic = s.nodes[3].dynamic = true;
  Geometry g = flatten(s);
  const auto first = RayScene::cached(s, g);
  EXPECT_DOUBLE_EQ(first->surfaceArea(), 3.5);
  const auto hit = [&](const RayScene& rays, float x) { return rays.intersect({{x, 0.4f, 5}, {0, 0, -1}}); };
  EXPECT_FLOAT_EQ(hit(*first, 0.25f).distance, 3);
  EXPECT_EQ(hit(*first, 0.25f).triangle / 2, 1u);
  EXPECT_FLOAT_EQ(hit(*first, 0.75f).distance, 4);
  EXPECT_EQ(hit(*first, 0.75f).triangle / 2, 2u);
  const Geometry before = g;
  for (uint32_t v = g.objects[1].firstVertex; v < g.positions.size(); ++v) g.positions[v].z += 1.5f;
  const auto moved = RayScene::cached(s, g);
  EXPECT_NE(first, moved);
  EXPECT_FLOAT_EQ(hit(*moved, 0.25f).distance, 2.5f);
  EXPECT_FLOAT_EQ(hit(*moved, 0.75f).distance, 2.5f);
  EXPECT_TRUE(moved->occluded({{0.75f, 0.4f, 5}, {0, 0, -1}, 0, 3}));
  EXPECT_FALSE(first->occluded({{0.75f, 0.4f, 5}, {0, 0, -1}, 0, 3}));
  EXPECT_EQ(first, RayScene::cached(s, before));
  for (uint32_t v = g.objects[1].firstVertex; v < g.positions.size(); ++v) g.positions[v] = glm::vec3(0.3f);
  const auto gone = RayScene::cached(s, g);  // no area, so nothing hits it
  EXPECT_FLOAT_EQ(hit(*gone, 0.75f).distance, 5);
  EXPECT_FLOAT_EQ(gone->intersect({{0.3f, 0.3f, 5}, {0, 0, -1}}).distance, 3);
}

}  // namespace
}  // namespace fovea::scene
