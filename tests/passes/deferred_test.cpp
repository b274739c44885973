// Tests shading with VPLs: closed forms, shadows from made-up maps, the filter, and random G-buffers against the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "fovea/error.h"
#include "tests/passes/deferred_scenes.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

using scene::Vpl;
constexpr double kPi = glm::pi<double>();

std::vector<float> run(PassTest& test, const GBuffer& g, const std::vector<Vpl>& vpls, int interleave) {
  g.wire(test);
  test.buffer("vpls", vpls, "Vpl").param("interleave", interleave);
  test.run();
  return test.floats("irradiance");
}

// ---- One VPL over a plane: E = I cos_s cos_l K(d) with cos = h / d ----------------------------------------

enum class Case { Clamped, ClampedInMeanFreePaths, Unclamped, Disc };

class OneVpl : public testing::TestWithParam<Case> {};

TEST_P(OneVpl, EqualsTheClosedForm) {
  const double height = 1.2, area = 0.7;
  const GBuffer g = makeFloor(40, 24, 0.2f);
  PassTest test("deferred");
  test.param("kernel", GetParam() == Case::Disc ? "disc" : "clamp");
  if (GetParam() == Case::Unclamped) test.param("clamp_distance", 0.0);
  if (GetParam() == Case::ClampedInMeanFreePaths) {  // of a cube with an edge of 3 m, 4 * 27 / 54 m
    scene::Scene cube;
    const uint32_t m = addMaterial(cube, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
    addRoom(cube, walls, 1.5f);
    test.scene(cube).param("clamp_unit", "mean-free-paths").param("clamp_distance", 0.75);
  }
  const auto image =
      run(test, g, {makeVpl({0.3f, float(height), -0.1f}, {0, -1, 0}, {10, 20, 30}, float(area))}, 4);
  const auto indirect = test.floats("indirect");
  for (size_t i = 0; i < g.pixels.size(); ++i) {
    const glm::dvec3 p(g.pixels[i].position);
    const double d2 = (p.x - 0.3) * (p.x - 0.3) + height * height + (p.z + 0.1) * (p.z + 0.1);
    double kernel = 1 / std::max(d2, 2.25);
    if (GetParam() == Case::Unclamped) kernel = 1 / d2;
    if (GetParam() == Case::Disc) kernel = 1 / (d2 + area / kPi);
    const double perIntensity = height * height / d2 * kernel / kPi;
    for (int c = 0; c < 3; ++c) {
      const double e = 10 * (c + 1) * perIntensity;
      ASSERT_NEAR(image[4 * i + size_t(c)], e, 1e-3 * e);
      ASSERT_NEAR(indirect[4 * i + size_t(c)], 0.25 * (c + 1) * e, 2e-3 * e);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, OneVpl,
                         testing::Values(Case::Clamped, Case::ClampedInMeanFreePaths, Case::Unclamped,
                                         Case::Disc));

// The surface behind the VPL and the one that faces away from it get no light.
TEST(Deferred, VplsShineToTheirSideOnly) {
  const GBuffer g = makeFloor(8, 8, 0.1f);
  for (const Vpl& v :
       {makeVpl({0, 1, 0}, {0, 1, 0}, glm::vec3(1)), makeVpl({0, -1, 0}, {0, 1, 0}, glm::vec3(1))}) {
    PassTest test("deferred");
    for (float x : run(test, g, {v}, 1)) EXPECT_TRUE(x == 0 || x == 1);  // alpha is 1
  }
}

// ---- Shadows from made-up maps ----------------------------------------------------------------------------

constexpr int kMap = 64;

// Distances along each texel's direction, as an exact rasteriser would store them.
std::vector<uint32_t> makeMap(const Vpl& v, const std::function<float(glm::vec3)>& distance) {
  std::vector<uint32_t> map(kMap * kMap, scene::kParaboloidEmpty);
  const glm::mat3 frame = scene::orthonormalFrame(v.normal);
  for (int y = 0; y < kMap; ++y)
    for (int x = 0; x < kMap; ++x) {
      const glm::vec3 local = scene::paraboloidTexelDirection({x, y}, kMap);
      if (local.z <= 0) continue;
      const float d = distance(scene::toWorld(frame, local));
      std::memcpy(&map[size_t(y * kMap + x)], &d, sizeof d);
    }
  return map;
}

float planeDistance(const Vpl& v, float y, glm::vec3 direction) {
  const float t = (y - v.position.y) / direction.y;
  return t > 0 ? t : std::numeric_limits<float>::infinity();
}

std::vector<float> runShadowed(PassTest& test, const GBuffer& g, const std::vector<Vpl>& vpls,
                               const std::vector<uint32_t>& maps, int interleave = 1) {
  test.image("atlas", VK_FORMAT_R32_UINT, kMap, kMap, uint32_t(vpls.size()), maps);
  return run(test, g, vpls, interleave);
}

// A surface must never shadow itself: at any height and tilt of the VPL, out to grazing light.
TEST(Deferred, ASurfaceDoesNotShadowItself) {
  const GBuffer g = makeFloor(48, 48, 0.25f);
  for (const float height : {0.05f, 0.5f, 2.0f, 8.0f}) {
    for (const glm::vec3 normal : {glm::vec3(0, -1, 0), glm::vec3(1, -0.4f, 0.2f), glm::vec3(0, 0, 1)}) {
      const std::vector<Vpl> vpls = {makeVpl({0.1f, height, 0.07f}, normal, glm::vec3(100))};
      const auto map = makeMap(vpls[0], [&](glm::vec3 d) { return planeDistance(vpls[0], 0, d); });
      PassTest shadowed("deferred"), open("deferred");
      const auto with = runShadowed(shadowed, g, vpls, map), without = run(open, g, vpls, 1);
      size_t lost = 0;
      for (size_t i = 0; i < with.size(); ++i) lost += with[i] != without[i];
      EXPECT_EQ(lost, 0u) << "height " << height;
    }
  }
}

// A lid of 0.3 m height keeps everything below dark; a lid over one half keeps that half dark.
TEST(Deferred, OccludersThrowShadows) {
  const GBuffer g = makeFloor(48, 48, 0.1f);
  const std::vector<Vpl> vpls = {makeVpl({0, 2, 0}, {0, -1, 0}, glm::vec3(100))};
  PassTest lid("deferred");
  const auto dark = runShadowed(
      lid, g, vpls, makeMap(vpls[0], [&](glm::vec3 d) { return planeDistance(vpls[0], 0.3f, d); }));
  for (size_t i = 0; i < dark.size(); i += 4) ASSERT_EQ(dark[i], 0);
  PassTest half("deferred"), open("deferred");
  const auto map =
      makeMap(vpls[0], [&](glm::vec3 d) { return planeDistance(vpls[0], d.x < 0 ? 0.3f : 0.0f, d); });
  const auto shadowed = runShadowed(half, g, vpls, map), lit = run(open, g, vpls, 1);
  for (size_t i = 0; i < g.pixels.size(); ++i) {
    const float x = g.pixels[i].position.x;
    if (x < -0.2f) {
      EXPECT_EQ(shadowed[4 * i], 0);
    }
    if (x > 0.2f) {
      EXPECT_EQ(shadowed[4 * i], lit[4 * i]);
    }
  }
}

// Both layouts of the atlas give the same picture.
TEST(Deferred, TiledAtlasEqualsLayers) {
  const GBuffer g = makeFloor(40, 40, 0.1f);
  const auto vpls = randomVpls(40);
  std::vector<uint32_t> layers, tiled(3 * 16 * kMap * kMap, scene::kParaboloidEmpty);
  for (uint32_t s = 0; s < 40; ++s) {
    const auto map =
        makeMap(vpls[s], [&](glm::vec3 d) { return random(20, s * 16 + uint32_t(8 + 8 * d.x)) * 4; });
    layers.insert(layers.end(), map.begin(), map.end());
    for (int y = 0; y < kMap; ++y)
      std::copy_n(map.begin() + y * kMap, kMap,
                  tiled.begin() + ((s / 16 * kMap + uint32_t(y)) * 16 + s % 16) * kMap);
  }
  PassTest a("deferred"), b("deferred");
  a.image("atlas", VK_FORMAT_R32_UINT, kMap, kMap, 40, layers);
  b.image("atlas", VK_FORMAT_R32_UINT, 16 * kMap, kMap, 3, tiled);
  const auto image = run(a, g, vpls, 2);
  EXPECT_EQ(image, run(b, g, vpls, 2));
  float sum = 0;
  for (size_t i = 0; i < image.size(); i += 4) sum += image[i];
  EXPECT_GT(sum, 0);
}

// ---- Interleaving and the filter --------------------------------------------------------------------------

// 1000 equal VPLs so far away that the wall is lit evenly: subsets of 62 and 63, and yet every pixel gets the same light.
TEST(Deferred, FilterOnAFlatWallIsExact) {
  const GBuffer g = makeFloor(45, 35, 0.01f);
  const std::vector<Vpl> vpls(1000, makeVpl({0, 1e4f, 0}, {0, -1, 0}, glm::vec3(1e5f)));
  const double expected = 1000 * 1e5 / 1e8 / kPi;
  for (const int n : {1, 2, 4, 8}) {
    PassTest test("deferred");
    const auto image = run(test, g, vpls, n);
    for (size_t i = 0; i < g.pixels.size(); ++i)
      ASSERT_NEAR(image[4 * i], expected, 1e-3 * expected) << "interleave " << n;
    EXPECT_EQ(test.counter("shaded_pixels"), double(g.pixels.size()));
    EXPECT_EQ(test.counter("incomplete"), 0);
    EXPECT_NEAR(test.counter("vpls_per_pixel"), 1000.0 / (n * n), 1e-6);
  }
}

// With different VPLs, only variation of the light across a block of pixels may show as a difference.
TEST(Deferred, FilterOnAFlatWallIsNearTheSumOfAllVpls) {
  const GBuffer g = makeFloor(64, 64, 0.01f);
  const auto vpls = randomVpls(500);
  PassTest all("deferred");
  const auto expected = run(all, g, vpls, 1);
  for (const int n : {2, 4, 8}) {
    PassTest test("deferred");
    const auto image = run(test, g, vpls, n);
    for (size_t i = 0; i < image.size(); ++i)
      ASSERT_NEAR(image[i], expected[i], 0.02 * expected[i]) << "interleave " << n;
  }
}

// Two walls in a corner, and a rod two pixels wide in front of them: each is lit as if it were alone, without a halo
// or a pattern.
TEST(Deferred, EdgesKeepTheirOwnLight) {
  const scene::PixelRays rays = raysOnto({-3, 0.32f, 3}, {-0.3f, 0, 0}, {0.005f, 0, 0.005f}, {0, 0.01f, 0});
  const GBuffer g(64, 64, rays, [&](int x, int y) {
    SurfacePixel p;
    const glm::vec3 ray = pointOn(rays, x, y, 1) - rays.eye;
    const float toLeft = -rays.eye.z / ray.z, toRight = -rays.eye.x / ray.x;  // walls, at z = 0 and at x = 0
    const bool rod = x == 44 || x == 45;
    p.distance = rod ? 0.8f * toRight : std::min(toLeft, toRight);
    p.position = rays.eye + p.distance * ray;
    p.normal = rod || toLeft < toRight ? glm::vec3(0, 0, 1) : glm::vec3(-1, 0, 0);
    return p;
  });
  std::vector<Vpl> vpls;  // far away: even light on each surface, different on each
  for (uint32_t i = 0; i < 256; ++i)
    vpls.push_back(makeVpl({-40 - 20 * random(1, i), 10 * random(2, i), 20 + 80 * random(3, i)}, {1, 0, -1},
                           glm::vec3(50)));
  PassTest all("deferred");
  const auto expected = run(all, g, vpls, 1);
  PassTest test("deferred");
  const auto image = run(test, g, vpls, 4);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      const size_t i = 4 * size_t(y * g.width + x);
      ASSERT_NEAR(image[i], expected[i], 0.02 * expected[i]) << x << "," << y;
    }
}

// ---- Numbers of VPLs --------------------------------------------------------------------------------------

class Counts : public testing::TestWithParam<uint32_t> {};

TEST_P(Counts, EqualTheReference) {
  const GBuffer g = makeFloor(21, 19, 0.02f);
  const auto vpls = randomVpls(GetParam());
  DeferredReference reference;
  PassTest one("deferred");
  expectImage(run(one, g, vpls, 1), g, reference.irradiance(g, vpls), 5e-3);
  PassTest four("deferred");
  const auto image = run(four, g, vpls, 4);
  if (GetParam() < 64) return;  // too few for 16 subsets: the pass takes fewer subsets
  reference.interleave = 4;
  expectImage(image, g, reference.irradiance(g, vpls), 5e-3);
}

// 1024 VPLs fill one page, 4096 fill four.
INSTANTIATE_TEST_SUITE_P(Pages, Counts, testing::Values(1, 2, 63, 1000, 1024, 1025, 4096));

TEST(Deferred, EmptySlotsGiveNoLight) {
  const GBuffer g = makeFloor(8, 8, 0.1f);
  PassTest test("deferred");
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1,
             std::vector<uint16_t>(8 * 8 * 4, glm::packHalf1x16(0.25f)));
  const auto image = run(test, g, std::vector<Vpl>(100), 4);
  const auto radiance = test.floats("radiance");
  for (size_t i = 0; i < image.size(); i += 4) {
    EXPECT_EQ(image[i], 0);
    EXPECT_EQ(radiance[i], 0.25f);
  }
}

TEST(Deferred, BackgroundShowsTheDirectImageOnly) {
  GBuffer g = makeFloor(33, 17, 0.05f);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if ((x / 5 + y / 4) % 2 == 0) g.pixels[size_t(y * g.width + x)].distance = 0;
  std::vector<float> direct;
  for (size_t i = 0; i < g.pixels.size(); ++i) direct.insert(direct.end(), {0.125f * float(i % 8), 1, 2, 1});
  std::vector<uint16_t> half;
  for (float v : direct) half.push_back(glm::packHalf1x16(v));
  PassTest test("deferred");
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, 33, 17, 1, half);
  const auto vpls = randomVpls(200);
  const auto image = run(test, g, vpls, 4), indirect = test.floats("indirect"),
             radiance = test.floats("radiance");
  size_t surfaces = 0;
  for (size_t i = 0; i < g.pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      const float total = direct[4 * i + c] + indirect[4 * i + c];
      EXPECT_NEAR(radiance[4 * i + c], total, 1e-3f * total);
      if (g.pixels[i].distance > 0) {
        EXPECT_GT(image[4 * i + c], 0);
        surfaces += c == 0;
      } else {
        EXPECT_EQ(image[4 * i + c], 0);
        EXPECT_EQ(radiance[4 * i + c], direct[4 * i + c]);
      }
    }
  EXPECT_EQ(test.counter("shaded_pixels"), double(surfaces));
}

// ---- Everything at once, against the CPU ------------------------------------------------------------------

// Bumpy patches with holes, random maps, both kernels, all interleave factors.
TEST(Deferred, RandomGBuffersEqualTheReference) {
  const GBuffer g = bumpyPatches(50, 38);
  const auto vpls = randomVpls(300);
  std::vector<uint32_t> maps;
  for (uint32_t s = 0; s < vpls.size(); ++s) {
    const auto map = makeMap(vpls[s], [&](glm::vec3 d) {
      const uint32_t cell = s * 64 + uint32_t(4 + 3.9f * d.x) * 8 + uint32_t(4 + 3.9f * d.z);
      return random(41, cell) < 0.3f ? 0.5f : 100.0f;
    });
    maps.insert(maps.end(), map.begin(), map.end());
  }
  for (const int n : {1, 2, 4, 8}) {
    DeferredReference reference;
    reference.disc = n % 4 != 0;
    reference.interleave = n;
    reference.atlas = &maps;
    reference.size = kMap;
    PassTest test("deferred");
    test.param("kernel", reference.disc ? "disc" : "clamp");
    const auto image = runShadowed(test, g, vpls, maps, n);
    // A point on the edge between two texels of a map may fall into either one; this affects a few of 300
    // decisions per pixel.
    expectImage(image, g, reference.irradiance(g, vpls), 0.01, g.pixels.size() * 3 / 100);
  }
}

TEST(Deferred, InterleaveMustBeAPowerOfTwo) {
  const GBuffer g = makeFloor(8, 8, 0.1f);
  PassTest test("deferred");
  try {
    run(test, g, randomVpls(100), 3);
    FAIL() << "accepted interleave 3";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("one of 1, 2, 4, 8"), std::string::npos) << e.what();
  }
}

TEST(Deferred, AnAtlasOfTooFewMapsIsRefused) {
  const GBuffer g = makeFloor(8, 8, 0.1f);
  PassTest test("deferred");
  test.image("atlas", VK_FORMAT_R32_UINT, kMap, kMap, 2, std::vector<uint32_t>(2 * kMap * kMap));
  EXPECT_THROW(run(test, g, randomVpls(3), 1), Error);
}

// The light of pass near-field is filtered together with that of the VPLs; the reflectance is applied afterwards.
TEST(Deferred, NearLightJoinsThatOfTheVpls) {
  const GBuffer g = makeFloor(32, 32, 0.1f);
  const std::vector<Vpl> vpls = randomVpls(64);
  PassTest without("deferred"), with("deferred");
  const std::vector<float> alone = run(without, g, vpls, 4);
  std::vector<uint16_t> near;
  for (int i = 0; i < 32 * 32; ++i)  // another share for each pixel of a block, 1 on average
    for (const float x : {float(i % 4) / 1.5f, 1.0f, 0.0f, 0.0f}) near.push_back(glm::packHalf1x16(x));
  with.image("near_field", VK_FORMAT_R16G16B16A16_SFLOAT, 32, 32, 1, near);
  const std::vector<float> both = run(with, g, vpls, 4);
  for (int y = 4; y < 28; ++y)
    for (int x = 4; x < 28; ++x) {
      const size_t i = 4 * (size_t(y) * 32 + size_t(x));
      EXPECT_NEAR(both[i] - alone[i], 1, 0.01) << x << "," << y;
      EXPECT_NEAR(both[i + 1] - alone[i + 1], 1, 0.005);
      EXPECT_NEAR(both[i + 2], alone[i + 2], 0.002f * alone[i + 2]);
    }
}

}  // namespace
}  // namespace fovea::test
