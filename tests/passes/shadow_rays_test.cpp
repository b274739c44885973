// Tests shadow edges by rays: the uncertain pixels against plain rays, and that the others are unchanged.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>

#include "fovea/error.h"
#include "fovea/test.h"
#include "framework/base/random.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"
#include "passes/path-trace/materials.h"
#include "tests/passes/candidates_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/vpl_intensity_reference.h"

namespace fovea::test {
namespace {

// Rays on the host and on the device.
class ShadowRays : public testing::TestWithParam<const char*> {
 protected:
  static bool onDevice() { return std::string(GetParam()) == "shadow-rays-device"; }
};
INSTANTIATE_TEST_SUITE_P(Tracers, ShadowRays, testing::Values("shadow-rays-host", "shadow-rays-device"),
                         [](const auto& test) { return std::string(test.param).substr(12); });

constexpr glm::ivec2 kSize(80, 60);
const glm::vec3 kRho(0.5f, 0.25f, 0.75f), kEmission(0.125f, 0, 0.25f);

// Two boxes on a floor that ends before the horizon, under a sun and a lamp.
Room litBoxes() {
  scene::Scene s;
  const uint32_t m = addMaterial(s, kRho);
  s.materials[m].emission = kEmission;
  addBox(s, m, {-1.5f, -1.2f, -5}, {1.5f, -1, -2});
  addBox(s, m, {-0.6f, -1, -3.5f}, {0, -0.2f, -3});
  addBox(s, m, {0.3f, -1, -4}, {0.6f, 0.3f, -3.5f});
  scene::Light sun;
  sun.direction = glm::normalize(glm::vec3(0.5f, -1, -0.3f));
  sun.color = {1, 0.5f, 0.25f};
  sun.intensity = 3;
  scene::Light lamp = sun;
  lamp.type = scene::LightType::Point;
  lamp.position = {-1, 0.5f, -2.5f};
  lamp.intensity = 5;
  s.lights = {sun, lamp};
  return lookInto(std::move(s), 8, kSize);
}

// What the rays on the device read of the surfaces.
void wireSurfaces(PassTest& test, const Room& room) {
  SeenImage surfaces(kSize);
  std::vector<uint64_t> albedo, emission;
  for (size_t i = 0; i < room.pixels.size(); ++i) {
    const Seen& seen = room.pixels[i];
    if (seen.there)
      surfaces.pixels[i] = {seen.position, glm::length(seen.position), seen.normal, seen.normal};
    albedo.push_back(glm::packHalf4x16(glm::vec4(kRho, 0)));
    emission.push_back(glm::packHalf4x16(glm::vec4(kEmission, 0)));
  }
  surfaces.wire(test);
  constexpr VkFormat kHalves = VK_FORMAT_R16G16B16A16_SFLOAT;
  test.image("gbuffer.albedo", kHalves, uint32_t(kSize.x), uint32_t(kSize.y), 1, albedo);
  test.image("gbuffer.emission", kHalves, uint32_t(kSize.x), uint32_t(kSize.y), 1, emission);
  test.image("gbuffer.specular", kHalves, 1, 1, 1, std::vector<uint64_t>(1));
}

// Over the room, whose direct light is `direct`.
void wire(PassTest& test, const Room& room, bool surfaces, const std::vector<uint64_t>& direct) {
  test.viewSize(uint32_t(kSize.x), uint32_t(kSize.y)).scene(room.scene);
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(kSize.x), uint32_t(kSize.y), 1, direct);
  if (surfaces) wireSurfaces(test, room);
}

glm::dvec3 radiance(const Room& room, const Seen& seen) {
  glm::dvec3 e(0);
  for (const scene::Light& light : room.scene.lights) {
    const path_trace::IncidentLight l = path_trace::incidentLight(light, seen.position);
    const double cosine = glm::dot(glm::dvec3(seen.normal), glm::dvec3(l.direction));
    if (cosine <= 0) continue;
    RayOptions options;
    if (light.type == scene::LightType::Point) options.tMax = l.distance;
    const glm::dvec3 origin = glm::dvec3(seen.position) + 1e-5 * glm::dvec3(seen.normal);
    if (!castRay(room.scene, room.geometry, origin, glm::dvec3(l.direction), options))
      e += cosine * glm::dvec3(l.irradiance);
  }
  return glm::dvec3(kEmission) + glm::dvec3(kRho) / glm::pi<double>() * e;
}

TEST_P(ShadowRays, PixelsInDoubtBecomeWhatRaysSay) {
  const Room room = litBoxes();
  std::vector<uint64_t> before;
  for (uint32_t i = 0; i < room.pixels.size(); ++i)
    before.push_back(glm::packHalf4x16(
        {uniformFloat(hashPcg(i)), uniformFloat(hashPcg(i + 10000)), 7, i % 3 == 0 ? 0.0f : 1.0f}));
  PassTest test(GetParam());
  wire(test, room, onDevice(), before);
  test.run();
  const auto after = test.values<uint64_t>("direct");
  int lit = 0, shadowed = 0, background = 0;
  for (uint32_t i = 0; i < before.size(); ++i) {
    if (i % 3 != 0) {
      ASSERT_EQ(after[i], before[i]) << "pixel " << i << " was in no doubt";
      continue;
    }
    const glm::vec4 got = glm::unpackHalf4x16(after[i]);
    EXPECT_EQ(got.a, 1);
    const Seen& seen = room.pixels[i];
    if (!seen.there) {
      ++background;
      EXPECT_EQ(after[i] & 0xffffffffffffu, before[i] & 0xffffffffffffu);
      continue;
    }
    const glm::dvec3 want = radiance(room, seen);
    ++(want.r > kEmission.r + 0.01 ? lit : shadowed);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 2e-3 * want[c]) << "pixel " << i;
  }
  EXPECT_GT(lit, 100);
  EXPECT_GT(shadowed, 10);
  EXPECT_GT(background, 50);
  EXPECT_EQ(test.counter("pixels"), (before.size() + 2) / 3);
}

// With full materials an uncertain pixel gets the light by the BSDF of the path tracer, as its neighbours in pass
// direct.
TEST(ShadowRaysHost, FullMaterialsAreThoseOfTheBsdf) {
  Room room = litBoxes();
  room.scene.materials[0].metallic = 0.5f;
  room.scene.materials[0].roughness = 0.4f;
  room.scene.materials[0].clearcoat = 0.5f;
  PassTest test("shadow-rays-host");
  test.viewSize(kSize.x, kSize.y).scene(room.scene).view("materials", "full");
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, kSize.x, kSize.y, 1,
             std::vector<uint64_t>(room.pixels.size(), glm::packHalf4x16({1, 2, 3, 0})));
  test.run();
  const auto after = test.values<uint64_t>("direct");
  const path_trace::Materials materials(room.scene, room.geometry);
  const scene::View& view = test.lastFrame().views[0];
  int lit = 0;
  for (uint32_t i = 0; i < room.pixels.size(); ++i) {
    const glm::dvec3 ray(view.rayDirection(glm::vec2(int(i) % kSize.x, int(i) / kSize.x) + 0.5f));
    const RayHit hit = castRay(room.scene, room.geometry, glm::dvec3(view.eye), ray);
    if (!hit) continue;
    const path_trace::SurfacePoint p = materials.at({hit.triangle, 0, float(hit.u), float(hit.v)});
    const glm::vec3 out = glm::normalize(view.eye - p.position);
    const glm::mat3 frame = path_trace::frameAround(p.normalTowards(out));
    const path_trace::Bsdf bsdf(p.bsdf, path_trace::toLocal(frame, out));
    glm::dvec3 want(p.emission);
    for (const scene::Light& light : room.scene.lights) {
      const path_trace::IncidentLight l = path_trace::incidentLight(light, p.position);
      RayOptions options;
      if (light.type == scene::LightType::Point) options.tMax = l.distance;
      const glm::dvec3 origin = glm::dvec3(p.position) + 1e-5 * glm::dvec3(p.face);
      if (castRay(room.scene, room.geometry, origin, glm::dvec3(l.direction), options)) continue;
      want += glm::dvec3(l.irradiance * bsdf.evaluate(path_trace::toLocal(frame, l.direction)));
      ++lit;
    }
    const glm::vec4 got = glm::unpackHalf4x16(after[i]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 5e-3 * want[c] + 1e-4) << "pixel " << i;
  }
  EXPECT_GT(lit, 500);
}

// Where the eye resolves little, the shadow map's answer stays.
TEST_P(ShadowRays, LeavesThePeripheryOut) {
  const Room room = litBoxes();
  const uint64_t doubt = glm::packHalf4x16({1, 2, 3, 0});
  PassTest test(GetParam());
  wire(test, room, onDevice(), std::vector<uint64_t>(room.pixels.size(), doubt));
  test.param("periphery", 2).view("fovea_radius", 0.1).view("pixels_per_degree", 200.0);
  test.run();
  const auto after = test.values<uint64_t>("direct");
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const bool fine = std::abs(float(x) + 0.5f - 40) < 8 && std::abs(float(y) + 0.5f - 30) < 8;
      EXPECT_EQ(after[size_t(y * kSize.x + x)] == doubt, !fine) << x << ", " << y;
    }
  EXPECT_EQ(test.counter("pixels"), 16 * 16);
}

TEST(ShadowRaysHost, SizeIsTheViews) {
  PassTest test("shadow-rays-host");
  test.viewSize(16, 8).scene(litBoxes().scene);
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, std::vector<uint64_t>(64));
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("8x8 pixels, its view 16x8"), std::string::npos) << e.what();
  }
}

TEST(ShadowRaysDevice, SizeIsThatOfTheGBuffer) {
  const Room room = litBoxes();
  PassTest test("shadow-rays-device");
  test.viewSize(uint32_t(kSize.x), uint32_t(kSize.y)).scene(room.scene);
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, std::vector<uint64_t>(64));
  wireSurfaces(test, room);
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("8x8 pixels, its G-buffer 80x60"), std::string::npos) << e.what();
  }
}

TEST(ShadowRaysHost, AnEmptySceneIsLeftAsItIs) {
  const std::vector<uint64_t> before(64, glm::packHalf4x16({1, 2, 3, 0}));
  PassTest test("shadow-rays-host");
  test.viewSize(8, 8);
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, before);
  test.run();
  EXPECT_EQ(test.values<uint64_t>("direct"), before);
}

}  // namespace
}  // namespace fovea::test
