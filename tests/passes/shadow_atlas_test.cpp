// Compares the atlas with the plainest possible ray caster: every texel, every triangle, in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "fovea/scene.h"
#include "fovea/test.h"
#include "framework/gpu/device.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "framework/session/test_device.h"
#include "shaders/records/vpl.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/vpl_scene.h"
#include "tests/references/paraboloid.h"

namespace fovea::test {
namespace {

using scene::Geometry;
using scene::Scene;
using scene::Vpl;

void addTriangle(Scene& s, glm::vec3 a, glm::vec3 b, glm::vec3 c, uint32_t material = 0) {
  scene::Primitive p;
  const glm::vec3 n = glm::cross(b - a, c - a);
  p.positions = {a, b, c};
  p.normals.assign(3, glm::length(n) > 0 ? glm::normalize(n) : glm::vec3(0, 0, 1));
  p.uvs = {{0, 0}, {1, 0}, {0, 1}};
  p.indices = {0, 1, 2};
  p.material = material;
  scene::Node node;
  node.mesh = uint32_t(s.meshes.size());
  s.meshes.push_back({"triangle", {p}});
  s.nodes.push_back(node);
}

// Points on the scene's triangles, on either side, as light paths would leave them.
std::vector<Vpl> surfaceVpls(const Geometry& g, uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform;
  std::vector<Vpl> list;
  while (list.size() < count) {
    const scene::Triangle& t = g.triangles[random() % g.triangles.size()];
    const float r = std::sqrt(uniform(random)), q = uniform(random);
    const glm::vec3 a = g.positions[t.v[0]], b = g.positions[t.v[1]], c = g.positions[t.v[2]];
    const glm::vec3 n = glm::cross(b - a, c - a);
    if (!(glm::length(n) > 1e-6f)) continue;
    list.push_back(vpl(a * (1 - r) + b * (r * (1 - q)) + c * (r * q), random() % 2 ? n : -n));
  }
  return list;
}

// Distance along the direction through point p of the map. The rule for the VPL's own surface is that of the pass:
// triangles whose plane is closer than epsilon block nothing.
double castTexel(const Scene& s, const Geometry& g, const Vpl& v, const glm::dmat3& frame, glm::dvec2 p,
                 double epsilon, bool alphaMask) {
  const double q = glm::dot(p, p);
  const glm::dvec3 direction = frame * (glm::dvec3(2.0 * p, 1 - q) / (1 + q));
  const glm::dvec3 origin(v.position);
  double best = std::numeric_limits<double>::infinity();
  for (const scene::Triangle& t : g.triangles) {
    const glm::dvec3 a(g.positions[t.v[0]]), e1 = glm::dvec3(g.positions[t.v[1]]) - a,
                                             e2 = glm::dvec3(g.positions[t.v[2]]) - a;
    const glm::dvec3 n = glm::cross(e1, e2), h = glm::cross(direction, e2), w = origin - a;
    const double det = glm::dot(e1, h);
    if (det == 0 || !(std::abs(glm::dot(n, w)) > epsilon * glm::length(n))) continue;
    const double u = glm::dot(w, h) / det;
    const glm::dvec3 k = glm::cross(w, e1);
    const double x = glm::dot(direction, k) / det, distance = glm::dot(e2, k) / det;
    if (u < 0 || x < 0 || u + x > 1 || distance <= 0 || distance >= best) continue;
    const scene::Material& m = s.materials[t.material()];
    if (alphaMask && m.masked) {
      const glm::vec2 uv =
          g.uvs[t.v[0]] * float(1 - u - x) + g.uvs[t.v[1]] * float(u) + g.uvs[t.v[2]] * float(x);
      if (scene::reflectance(s, m, uv).a < m.alphaCutoff) continue;
    }
    best = distance;
  }
  return best;
}

struct Check {
  int size = 64;
  bool alphaMask = true;
  int stride = 1;         // every stride-th texel in x and y
  double allowed = 1e-3;  // share of texels that may lie on the other side of a silhouette
};

// A texel that differs must be next to a discontinuity: rays that pass at a thousandth of a texel bracket its value.
void expectExact(const Scene& s, const std::vector<Vpl>& vpls, const std::vector<float>& atlas,
                 scene::AtlasLayout layout, const Check& check) {
  const Geometry g = scene::flatten(s);
  const double diagonal = g.empty() ? 0 : glm::length(g.boundsMax - g.boundsMin), epsilon = 1e-5 * diagonal;
  const int width = layout.size << layout.shift;
  auto close = [](double a, double b) { return a == b || std::abs(a - b) <= 1e-4 * b + 1e-6; };
  size_t texels = 0, different = 0, hits = 0;
  for (uint32_t slot = 0; slot < vpls.size(); ++slot) {
    const bool drawn = vpls[slot].intensity != glm::vec3(0);
    const glm::dmat3 frame(scene::orthonormalFrame(vpls[slot].normal));
    for (int y = 0; y < check.size; y += check.stride)
      for (int x = 0; x < check.size; x += check.stride) {
        const glm::ivec3 at = scene::atlasTexel(slot, {x, y}, layout);
        const float got = atlas[(size_t(at.z) * layout.size + at.y) * width + at.x];
        const glm::dvec2 p(scene::paraboloidTexelCentre({x, y}, check.size));
        if (!drawn || glm::dot(p, p) >= 1) {
          ASSERT_EQ(got, kInfinity) << "slot " << slot << " texel " << x << " " << y;
          continue;
        }
        ++texels;
        const double want = castTexel(s, g, vpls[slot], frame, p, epsilon, check.alphaMask);
        hits += want < kInfinity;
        if (close(got, want)) continue;
        ++different;
        double least = want, most = want;
        for (int i = 0; i < 16; ++i) {
          const double angle = i * 0.3927, reach = 2e-3 / check.size;
          const double t =
              castTexel(s, g, vpls[slot], frame, p + reach * glm::dvec2(std::cos(angle), std::sin(angle)),
                        epsilon, check.alphaMask);
          least = std::min(least, t);
          most = std::max(most, t);
        }
        EXPECT_TRUE((got >= least * (1 - 1e-4) && got <= most * (1 + 1e-4)))
            << "slot " << slot << " texel " << x << " " << y << ": " << got << ", rays say " << want << " ("
            << least << " to " << most << ")";
      }
  }
  EXPECT_LE(double(different), check.allowed * double(texels))
      << different << " of " << texels << " texels differ";
  ::testing::Test::RecordProperty("texels", int(texels));
  ::testing::Test::RecordProperty("hits", int(hits));
}

scene::AtlasLayout layoutOf(const PassTest& test) {
  return scene::atlasLayout(int(test.desc("atlas").width), int(test.desc("atlas").height));
}

void runAndExpectExact(const Scene& s, const std::vector<Vpl>& vpls, const Check& check = {}) {
  PassTest test("shadow-atlas");
  test.scene(s).param("size", check.size).param("alpha_mask", check.alphaMask).buffer("vpls", vpls, "Vpl");
  test.run();
  ASSERT_EQ(layoutOf(test).size, check.size);
  expectExact(s, vpls, test.values<float>("atlas"), layoutOf(test), check);
}

TEST(ShadowAtlas, EqualsRaysInTheCornellBox) {
  const Scene s = scene::builtin("cornellbox");
  runAndExpectExact(s, surfaceVpls(scene::flatten(s), 12, 3), {.size = 48});
  runAndExpectExact(s, surfaceVpls(scene::flatten(s), 4, 4), {.size = 128, .stride = 3});
}

TEST(ShadowAtlas, EqualsRaysAmongLargeRandomTriangles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-3, 3);
  auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
  for (int count : {1, 6, 80}) {
    Scene s = emptyScene();
    for (int i = 0; i < count; ++i) addTriangle(s, point(), point(), point());
    std::vector<Vpl> vpls = surfaceVpls(scene::flatten(s), 12, 6);
    for (int i = 0; i < 12; ++i) vpls.push_back(vpl(point(), point()));
    runAndExpectExact(s, vpls, {.size = 64});
  }
}

// Everything as seen from the origin in direction n.
TEST(ShadowAtlas, EqualsRaysOnAdversarialTriangles) {
  const std::vector<std::vector<glm::vec3>> cases = {
      {{-900, -700, 1}, {900, -700, 1}, {0, 1000, 1}},         // covers almost the whole hemisphere
      {{-1000, 0, -800}, {1000, 0.1f, -800}, {0, 3, 900}},     // huge, upright, most of it below the horizon
      {{-1000, 2, -1e-3f}, {1000, 2, -1e-3f}, {0, 2, 1e-3f}},  // barely above the horizon
      {{-1, -1, -1}, {1, -1, -1}, {0, 1, 2}},                  // crosses the horizon plane beside the VPL
      {{-5, -5, -2}, {5, -5, -2}, {0, 8, 0.5f}},               // around the direction straight down
      {{0.5f, -2, 0.3f}, {0.5f, 2, 0.3f}, {0.5f, 2.001f, 0.301f}},  // sliver
      {{-4, -4, 2}, {4, 4.002f, 2}, {4, 4, 2}},                     // sliver over the axis
      {{0, 0, 1}, {1, 0, 1.5f}, {0, 1, 1.5f}},                      // vertex on the axis
      {{-1, 0, 1}, {1, 0, 1}, {0, 2, 1}},                           // edge through the axis
      {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}},                            // vertex at the VPL
      {{-1, 0, 0}, {1, 0, 0}, {0, 1, 1}},                           // edge through the VPL
      {{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}},                         // VPL inside: its own surface
      {{-1, -1, 1e-3f}, {1, -1, 1e-3f}, {0, 2, 1e-3f}},             // just above the VPL: no longer its own
      {{0.001f, 0, 0.002f}, {0.002f, 0, 0.002f}, {0.001f, 0.001f, 0.003f}},  // tiny and near
      {{3, 3, 3}, {3, 3, 3}, {4, 3, 3}},                                     // no area
      {{-2, 1, 0}, {2, 1, 0}, {0, 1, -3}},                                   // touches the horizon from below
      {{-1, -2, -1}, {-1, 2, -1}, {-1, 0, -3}},                              // wholly behind
  };
  const std::vector<glm::vec3> normals = {{0, 0, 1}, {0, 0, -1}, {0.3f, -0.2f, 0.9f}, {1, 0, 0}, {-1, 2, -3}};
  for (size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    Scene s = emptyScene();
    addTriangle(s, cases[i][0], cases[i][1], cases[i][2]);
    std::vector<Vpl> vpls;
    for (glm::vec3 n : normals) vpls.push_back(vpl({0, 0, 0}, n));
    runAndExpectExact(s, vpls, {.size = 64});
  }
  Scene all = emptyScene();
  for (const auto& c : cases) addTriangle(all, c[0], c[1], c[2]);
  runAndExpectExact(all, {vpl({0, 0, 0}, {0, 0, 1}), vpl({0.1f, 0.2f, 0.3f}, {1, 1, 1})}, {.size = 128});
}

// A map's largest triangles take several dispatches at this size.
TEST(ShadowAtlas, LargestMapIsComplete) {
  Scene s = emptyScene();
  addTriangle(s, {-900, -700, 1}, {900, -700, 1}, {0, 1000, 1});
  addTriangle(s, {-1, -1, 0.5f}, {1, -1, 0.5f}, {0, 1, 0.5f});
  runAndExpectExact(s, {vpl({0, 0, 0}, {0, 0, 1})}, {.size = 1024, .stride = 7});
}

// As many texels and pairs as there can be: the triangle covers all maps of more VPLs than share a dispatch.
TEST(ShadowAtlas, ATriangleMayCoverAllMaps) {
  Scene s;
  s.materials.emplace_back();
  addTriangle(s, {-900, -900, 1}, {900, -900, 1}, {0, 1800, 1});
  std::vector<Vpl> vpls;
  for (int i = 0; i < 600; ++i) vpls.push_back(vpl({0.01f * float(i), 0, 0}, {0, 0, 1}));
  runAndExpectExact(s, vpls, {.size = 128, .stride = 7});
}

TEST(ShadowAtlas, OwnSurfaceDoesNotBlock) {
  Scene s = emptyScene();
  addQuad(s, 0, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5});
  std::vector<Vpl> vpls;
  for (float offset : {0.0f, 3e-6f, -3e-6f})  // where rounding may leave the end of a path
    for (glm::vec3 n : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(0.5f, 1, 0.3f)})
      vpls.push_back(vpl({0.3f, offset, -0.7f}, n));
  PassTest test("shadow-atlas");
  test.scene(s).param("size", 32).buffer("vpls", vpls, "Vpl");
  test.run();
  for (float v : test.values<float>("atlas")) ASSERT_EQ(v, kInfinity);
}

TEST(ShadowAtlas, HolesOfMaskedMaterialsAreOpen) {
  Scene s = emptyScene();
  s.textures.push_back(checkerTexture());
  scene::Material masked;
  masked.masked = true;
  masked.baseColorTexture.texture = 0;
  s.materials.push_back(masked);
  addQuad(s, 1, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1});
  addQuad(s, 0, {-4, -4, 2}, {4, -4, 2}, {4, 4, 2}, {-4, 4, 2});
  const std::vector<Vpl> vpls = {vpl({0, 0, 0}, {0, 0, 1}), vpl({0.5f, -0.3f, 0.2f}, {0.2f, 0.3f, 1})};
  // The alpha test is on a bilinear ramp: its threshold is a silhouette.
  runAndExpectExact(s, vpls, {.size = 96, .alphaMask = true, .allowed = 3e-3});
  runAndExpectExact(s, vpls, {.size = 96, .alphaMask = false});
}

TEST(ShadowAtlas, EmptySlotsStayEmptyAndUncounted) {
  Scene s = emptyScene();
  addBox(s, 0, {-1, -1, -1}, {1, 1, 1});
  std::vector<Vpl> vpls;
  for (int i = 0; i < 50; ++i) {
    vpls.push_back(vpl({0.01f * float(i), 0.1f, 0}, {1, 0, float(i)}));
    if (i % 3 == 1) vpls.back().intensity = glm::vec3(0);
  }
  PassTest test("shadow-atlas");
  test.scene(s).param("size", 16).buffer("vpls", vpls, "Vpl");
  test.run();
  expectExact(s, vpls, test.values<float>("atlas"), layoutOf(test), {.size = 16});
  EXPECT_EQ(test.counter("maps"), 33);
  EXPECT_GT(test.counter("large_pairs"), 0);

  // A slot that empties loses its map; one that fills gets one.
  for (size_t i = 0; i < vpls.size(); ++i) vpls[i].intensity = glm::vec3(i % 3 == 2 ? 0.0f : 2.0f);
  test.set("vpls", vpls);
  test.run();
  expectExact(s, vpls, test.values<float>("atlas"), layoutOf(test), {.size = 16});
  for (Vpl& v : vpls) v.intensity = glm::vec3(0);
  test.set("vpls", vpls);
  test.run();
  for (float v : test.values<float>("atlas")) ASSERT_EQ(v, kInfinity);
  EXPECT_EQ(test.counter("maps"), 0);
}

TEST(ShadowAtlas, EmptySceneBlocksNothing) {
  PassTest test("shadow-atlas");
  test.param("size", 8).buffer("vpls", std::vector<Vpl>{vpl({0, 0, 0}, {0, 1, 0})}, "Vpl");
  test.run();
  for (float v : test.values<float>("atlas")) ASSERT_EQ(v, kInfinity);
}

TEST(ShadowAtlas, MoreMapsThanLayersAreTiled) {
  Scene s = emptyScene();
  addBox(s, 0, {-1, -1, -1}, {1, 1, 1});
  const uint32_t slots = testDevice().limits().maxImageArrayLayers + 52;
  if (slots > 5000)
    GTEST_SKIP() << "this device has " << slots - 52 << " layers: the maps would take long to check";
  std::vector<Vpl> vpls;
  for (uint32_t i = 0; i < slots; ++i) {
    const float t = 6.0f * float(i) / float(slots);
    vpls.push_back(
        vpl({0.9f * std::sin(7 * t), 0.5f, 0.9f * std::cos(11 * t)}, {std::sin(t), std::cos(t), 0.3f}));
  }
  PassTest tiled("shadow-atlas");
  tiled.scene(s).param("size", 8).param("layout", "tiled").buffer("vpls", vpls, "Vpl");
  tiled.run();
  EXPECT_EQ(layoutOf(tiled).shift, 4);
  EXPECT_EQ(tiled.desc("atlas").layers, (slots + 15) / 16);
  expectExact(s, vpls, tiled.values<float>("atlas"), layoutOf(tiled), {.size = 8});

  PassTest layers("shadow-atlas");
  layers.scene(s).param("size", 8).buffer("vpls", vpls, "Vpl");
  try {
    layers.run();
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    const std::string text = e.what();
    EXPECT_NE(text.find(std::to_string(slots) + " layers of 8x8 exceed this device's maxImageArrayLayers"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("layout to `tiled`"), std::string::npos) << text;
  }
}

TEST(ShadowAtlas, IsRepeatableBitForBit) {
  const Scene s = scene::builtin("cornellbox");
  const std::vector<Vpl> vpls = surfaceVpls(scene::flatten(s), 40, 9);
  PassTest a("shadow-atlas"), b("shadow-atlas");
  a.scene(s).param("size", 32).buffer("vpls", vpls, "Vpl");
  b.scene(s).param("size", 32).buffer("vpls", vpls, "Vpl");
  a.run();
  b.run(3);
  EXPECT_EQ(a.bytes("atlas"), b.bytes("atlas"));
}

// Where an object is coarser for VPL maps, the maps are those of the coarser scene, including moving parts, masked
// parts and the simplified mesh.
TEST(ShadowAtlas, SeesTheTrianglesThatAreCoarserForLight) {
  Scene s = scene::builtin("cornellbox");
  s.textures.push_back(checkerTexture());
  s.materials.emplace_back();
  s.materials.back().masked = true;
  s.materials.back().baseColorTexture.texture = uint32_t(s.textures.size() - 1);
  s.meshes[0].primitives[0].material = uint32_t(s.materials.size() - 1);
  for (size_t i = 0; i < s.nodes.size(); i += 3) s.nodes[i].dynamic = true;
  Scene coarse = s;
  for (size_t m = 0; m < s.meshes.size(); ++m)
    for (size_t n = 0; n < s.meshes[m].primitives.size(); ++n) {
      std::vector<uint32_t>& kept = coarse.meshes[m].primitives[n].indices;
      if (kept.size() > 6) kept.resize(kept.size() / 6 * 3);
      if (m % 2 == 0)
        s.meshes[m].primitives[n].lightIndices = kept;
      else
        kept = s.meshes[m].primitives[n].indices;
    }
  const Geometry g = scene::flatten(s);
  ASSERT_GT(g.staticTriangles, 0u);
  ASSERT_LT(g.staticTriangles, g.triangles.size());
  ASSERT_LT(g.lightTriangles.size(), g.triangles.size());
  const std::vector<Vpl> vpls = surfaceVpls(g, 20, 8);
  for (const char* technique : {"exact", "simplified"}) {
    const auto atlasOf = [&](const Scene& scene) {
      PassTest test("shadow-atlas");
      test.scene(scene).param("size", 48).param("technique", technique).param("simplify_ratio", 1.0);
      test.buffer("vpls", vpls, "Vpl").run();
      return test.values<float>("atlas");
    };
    const std::vector<float> got = atlasOf(s);
    EXPECT_EQ(got, atlasOf(coarse)) << technique;
    Scene fine = s;
    for (scene::Mesh& mesh : fine.meshes)
      for (scene::Primitive& p : mesh.primitives) p.lightIndices.clear();
    EXPECT_NE(got, atlasOf(fine)) << technique;
  }
}

TEST(ShadowAtlas, SimplifiedKeepingAllIsExactAndKeepingLessIsClose) {
  Scene s = scene::builtin("cornellbox");
  s.textures.push_back(checkerTexture());
  scene::Material masked;
  masked.masked = true;
  masked.baseColorTexture.texture = uint32_t(s.textures.size() - 1);
  s.materials.push_back(masked);
  const Geometry g = scene::flatten(s);
  const glm::vec3 middle = 0.5f * (g.boundsMin + g.boundsMax);
  addQuad(s, uint32_t(s.materials.size() - 1), middle + glm::vec3(-1, 0, 1), middle + glm::vec3(1, 0, 1),
          middle + glm::vec3(1, 0, -1), middle + glm::vec3(-1, 0, -1));
  // VPLs on the walls that face inwards; a light inside a curved object sees only the simplified surface close by.
  std::vector<Vpl> vpls;
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f})
      for (float along : {0.3f, 0.6f, 0.8f}) {
        glm::vec3 at = glm::mix(g.boundsMin, g.boundsMax, along), n(0);
        n[axis] = -side;
        at[axis] = middle[axis] + 0.499f * side * (g.boundsMax - g.boundsMin)[axis];
        vpls.push_back(vpl(at, n));
      }
  auto run = [&](PassTest& test) {
    test.scene(s).param("size", 64).buffer("vpls", vpls, "Vpl");
    test.run();
    return test.values<float>("atlas");
  };
  PassTest exact("shadow-atlas"), all("shadow-atlas"), some("shadow-atlas");
  all.param("technique", "simplified").param("simplify_ratio", 1.0);
  some.param("technique", "simplified").param("simplify_ratio", 0.3);
  const std::vector<float> want = run(exact);
  EXPECT_EQ(run(all), want);
  EXPECT_EQ(all.counter("masked_pairs"), exact.counter("masked_pairs"));

  const std::vector<float> got = run(some);
  size_t hits = 0, near = 0;
  for (size_t i = 0; i < want.size(); ++i) {
    hits += want[i] < kInfinity;
    near += want[i] < kInfinity && std::abs(got[i] - want[i]) < 0.03f + 0.01f * want[i];
  }
  EXPECT_GT(double(near), 0.95 * double(hits));
  EXPECT_LT(some.counter("small_pairs") + some.counter("large_pairs"),
            0.7 * (exact.counter("small_pairs") + exact.counter("large_pairs")));
}

}  // namespace
}  // namespace fovea::test
