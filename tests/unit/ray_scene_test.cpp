#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "tests/references/passage.h"
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

// Who traces decides what lets a part of the light through; diffuse materials take it for a mask, or for solid.
TEST(RayScene, RaysMeetWhatLetsLightThrough) {
  Material veil, glass;
  veil.masked = veil.blended = true;
  veil.baseColor.a = 0.3f;  // below the cutoff
  glass.transmission = 0.8f;
  const Ray ray{{0.5f, 2, -0.5f}, {0, -1, 0}};
  for (const Material& m : {veil, glass}) {
    const Scene s = layers(m);
    const Geometry g = flatten(s);
    const RayScene met(s, g, Passing::Met), never(s, g);
    EXPECT_TRUE(met.meetsTransparency());
    EXPECT_FALSE(never.meetsTransparency());
    EXPECT_TRUE(met.intersect(ray));
    EXPECT_TRUE(met.occluded(ray));
    EXPECT_EQ(bool(never.intersect(ray)), !m.blended);
  }
}

// The share that passes a BLEND surface and a pane behind it, as one factor per channel; an opaque surface stops the
// rest.
TEST(RayScene, LightThatPassesTakesOnTheColourOfGlass) {
  Material veil, glass;
  veil.masked = veil.blended = true;
  veil.baseColor.a = 0.3f;
  glass.transmission = 0.8f;
  glass.roughness = 0.2f;
  glass.baseColor = {0.9f, 0.6f, 0.3f, 1};
  Frame frame;
  Scene s = layers(veil);
  s.materials.push_back(glass);
  addQuad(s, 2, {0, 0.5f, 0}, {1, 0, 0}, {0, 0, -1});
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  const Geometry g = flatten(s);
  frame.scene = &s, frame.geometry = &g;
  const RayScene rays(s, g, Passing::Met), solid(s, g);
  const auto along = [&](const RayScene& r, float far) {
    return visibility(frame, r, {{0.5f, 2, -0.5f}, {0, -2, 0}, 0, far / 2});
  };
  EXPECT_EQ(along(rays, 0.4f), glm::vec3(1));
  EXPECT_NEAR(along(rays, 0.9f).r, 0.7, 1e-5);
  EXPECT_NEAR(along(rays, 1.4f).g, 0.49, 1e-5);
  const glm::vec3 all = along(rays, 1.9f);
  const float passes = passage(s, glass, {0, 0}, 1);
  EXPECT_NEAR(passes, 0.8f * 0.6f * 0.95f, 0.01f);
  EXPECT_NEAR((all.r + all.g + all.b) / 3, 0.49f * passes, 1e-4);
  EXPECT_NEAR(all.r / all.b, 3, 1e-4);
  EXPECT_NEAR(all.r / all.g, 1.5, 1e-4);
  EXPECT_EQ(along(rays, 3), glm::vec3(0));
  EXPECT_EQ(along(solid, 1.4f), glm::vec3(1));  // the mask of the veils is open
  EXPECT_EQ(along(solid, 1.9f), glm::vec3(0));  // and glass is solid
}

// The shares of the pixels of a square, and of the turns of a pixel, that are stopped are close to what is stopped, and
// surfaces behind each other let rays pass independently.
TEST(RayScene, FewChancesTellTheShare) {
  const float share = 0.4f;
  double squares = 0, turns = 0, both = 0;
  constexpr uint32_t kKeys = 64, kTurns = 4096;
  for (uint32_t k = 0; k < kKeys; ++k) {
    const uint32_t key = hashPcg(k), other = hashPcg(k + kKeys);
    double square = 0, turn = 0;
    for (uint32_t i = 0; i < 16; ++i) {
      square += passageChance(key, {100 + i % 4, 50 + i / 4}, 7) < share;
      turn += passageChance(key, {100, 50}, i + 7) < share;
    }
    squares += std::pow(square / 16 - share, 2) / kKeys;
    turns += std::pow(turn / 16 - share, 2) / kKeys;
    for (uint32_t i = 0; i < kTurns; ++i)
      both += (passageChance(key, {i % 5, 3}, i) < share && passageChance(other, {i % 5, 3}, i) < share) /
              double(kTurns * kKeys);
  }
  EXPECT_LT(std::sqrt(squares), 0.06);  // of random numbers 0.12
  EXPECT_LT(std::sqrt(turns), 0.06);
  EXPECT_NEAR(both, share * share, 0.01);
}

TEST(RayScene, CacheKnowsWaysOfPassing) {
  Scene s = layers({});
  Geometry g = flatten(s);
  EXPECT_EQ(RayScene::cached(s, g), RayScene::cached(s, g, Passing::Met));  // nothing lets light through
  s.materials[1].masked = s.materials[1].blended = true;
  g = flatten(s);
  EXPECT_NE(RayScene::cached(s, g), RayScene::cached(s, g, Passing::Met));
}

TEST(RayScene, KeyFollowsHoles) {
  Scene s = layers({});
  const uint64_t opaque = flatten(s).stillKey;
  s.materials[1].alphaCutoff = 0.25f;
  EXPECT_EQ(flatten(s).stillKey, opaque) << "it has no holes";
  s.materials[1].masked = true;
  const uint64_t masked = flatten(s).stillKey;
  EXPECT_NE(masked, opaque);
  s.materials[1].alphaCutoff = 0.75f;
  const uint64_t wider = flatten(s).stillKey;
  EXPECT_NE(wider, masked);
  s.materials[1].blended = true;
  EXPECT_NE(flatten(s).stillKey, wider);
}

// Alpha of the vertex colours falls from 1 to 0 along a side of a masked triangle.
TEST(RayScene, AlphaOfVertexColoursCutsHoles) {
  Scene s;
  test::addMaterial(s, glm::vec3(0.5f));
  s.materials[0].masked = true;
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, {0, 0, 1});
  p.uvs.assign(3, {0, 0});
  p.indices = {0, 1, 2};
  p.colors = {{1, 1, 1, 1}, {1, 1, 1, 0}, {1, 1, 1, 1}};
  s.meshes.push_back({"fading", {p}});
  s.nodes.emplace_back().mesh = 0;
  const auto solid = [&](float x) {
    const Geometry g = flatten(s);
    return RayScene(s, g).occluded({{x, 0.1f, 1}, {0, 0, -1}});
  };
  EXPECT_TRUE(solid(0.49f));
  EXPECT_FALSE(solid(0.51f));
  const uint64_t key = flatten(s).stillKey;
  s.materials[0].baseColor.a = 0.8f;
  EXPECT_TRUE(solid(0.37f));
  EXPECT_FALSE(solid(0.38f));
  s.materials[0].masked = false;
  EXPECT_TRUE(solid(0.8f));
  s.materials[0].masked = true;
  s.materials[0].baseColor.a = 1;
  s.meshes[0].primitives[0].colors[1].a = 0.25f;
  EXPECT_NE(flatten(s).stillKey, key);
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
  g.stillKey = 0;
  const auto moved = RayScene::cached(s, g);
  EXPECT_NE(first, moved);
  EXPECT_FLOAT_EQ(moved->intersect({{0.5f, 0.5f, 1}, {0, 0, -1}}).distance, 2);
  EXPECT_EQ(first, RayScene::cached(s, copy));  // the two most recent are kept
}

// The triangles of a large scene are not read again for every pass of every frame.
TEST(RayScene, CacheTrustsTheKeyOfWhatStays) {
  Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Geometry g = flatten(s);
  EXPECT_EQ(g.stillKey, stillKey(s, g));
  const auto first = RayScene::cached(s, g);
  g.positions[0].z -= 1;
  EXPECT_NE(g.stillKey, stillKey(s, g));
  EXPECT_EQ(first, RayScene::cached(s, g));
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
