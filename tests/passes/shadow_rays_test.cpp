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
#include "tests/passes/full_materials_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/vpl_intensity_reference.h"
#include "tests/passes/where_rays_run.h"

namespace fovea::test {
namespace {

class ShadowRays : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, ShadowRays, testing::Bool(), nameOfPlace);

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

// Over the room, whose direct light is `direct`. material: if it is full.
void wire(PassTest& test, const Room& room, const std::vector<uint64_t>& direct,
          const path_trace::BsdfParameters* material = nullptr) {
  GBuffer seen(kSize.x, kSize.y, room.camera, [&](int x, int y) {
    const Seen& s = room.pixels[size_t(y * kSize.x + x)];
    SurfacePixel p;
    if (!s.there) return p;
    p.position = s.position;
    p.distance = glm::length(s.position);  // the eye is at the origin
    p.normal = s.normal;
    p.albedo = kRho;
    if (material) setMaterial(p, *material, glm::dot(s.normal, -glm::normalize(s.position)));
    return p;
  });
  seen.full = material != nullptr;
  seen.wire(test);
  const auto width = uint32_t(kSize.x), height = uint32_t(kSize.y);
  const std::vector<uint64_t> emission(room.pixels.size(), glm::packHalf4x16(glm::vec4(kEmission, 0)));
  test.image("gbuffer.emission", VK_FORMAT_R16G16B16A16_SFLOAT, width, height, 1, emission);
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, width, height, 1, direct);
  test.scene(room.scene).view("materials", material ? "full" : "diffuse");
}

bool isLit(const Room& room, const Seen& seen, const scene::Light& light,
           const path_trace::IncidentLight& incident) {
  RayOptions options;
  if (light.type == scene::LightType::Point) options.tMax = incident.distance;
  const glm::dvec3 origin = glm::dvec3(seen.position) + 1e-5 * glm::dvec3(seen.normal);
  return glm::dot(seen.normal, incident.direction) > 0 &&
         !castRay(room.scene, room.geometry, origin, glm::dvec3(incident.direction), options);
}

glm::dvec3 radiance(const Room& room, const Seen& seen) {
  glm::dvec3 e(0);
  for (const scene::Light& light : room.scene.lights) {
    const path_trace::IncidentLight l = path_trace::incidentLight(light, seen.position);
    if (isLit(room, seen, light, l))
      e += double(glm::dot(seen.normal, l.direction)) * glm::dvec3(l.irradiance);
  }
  return glm::dvec3(kEmission) + glm::dvec3(kRho) / glm::pi<double>() * e;
}

TEST_P(ShadowRays, PixelsInDoubtBecomeWhatRaysSay) {
  const Room room = litBoxes();
  std::vector<uint64_t> before;
  for (uint32_t i = 0; i < room.pixels.size(); ++i)
    before.push_back(glm::packHalf4x16(
        {uniformFloat(hashPcg(i)), uniformFloat(hashPcg(i + 10000)), 7, i % 3 == 0 ? 0.0f : 1.0f}));
  RayPassTest test("shadow-rays");
  wire(test, room, before);
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
TEST_P(ShadowRays, FullMaterialsAreThoseOfTheBsdf) {
  const Room room = litBoxes();
  const path_trace::BsdfParameters material = bsdfParameters(kRho, 0.5f, 0.4f);
  RayPassTest test("shadow-rays");
  wire(test, room, std::vector<uint64_t>(room.pixels.size(), glm::packHalf4x16({1, 2, 3, 0})), &material);
  test.run();
  const auto after = test.values<uint64_t>("direct");
  int lit = 0;
  for (uint32_t i = 0; i < room.pixels.size(); ++i) {
    const Seen& seen = room.pixels[i];
    if (!seen.there) continue;
    const glm::mat3 frame = path_trace::frameAround(seen.normal);
    const path_trace::Bsdf bsdf(material, path_trace::toLocal(frame, -glm::normalize(seen.position)));
    glm::dvec3 want(kEmission);
    for (const scene::Light& light : room.scene.lights) {
      const path_trace::IncidentLight l = path_trace::incidentLight(light, seen.position);
      if (!isLit(room, seen, light, l)) continue;
      want += glm::dvec3(l.irradiance * bsdf.evaluate(path_trace::toLocal(frame, l.direction)));
      ++lit;
    }
    const glm::vec4 got = glm::unpackHalf4x16(after[i]);
    // Dielectrics have a polynomial for Fresnel's equations, and mixtures one curve for both of their parts.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 0.01 * want[c] + 1e-4) << "pixel " << i;
  }
  EXPECT_GT(lit, 500);
}

// Where the eye resolves little, the shadow map's answer stays.
TEST_P(ShadowRays, LeavesThePeripheryOut) {
  const Room room = litBoxes();
  const uint64_t doubt = glm::packHalf4x16({1, 2, 3, 0});
  RayPassTest test("shadow-rays");
  wire(test, room, std::vector<uint64_t>(room.pixels.size(), doubt));
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

TEST(ShadowRaysInputs, SizeIsThatOfTheGBuffer) {
  PassTest test("shadow-rays");
  wire(test, litBoxes(), std::vector<uint64_t>(kSize.x * kSize.y));
  test.image("direct", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, std::vector<uint64_t>(64));
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("(direct.width is 8, gbuffer.distance.width is 80, direct.height is "
                                         "8, gbuffer.distance.height is 60)"),
              std::string::npos)
        << e.what();
  }
}

TEST_P(ShadowRays, AnEmptySceneKeepsItsLight) {
  Room nothing;
  nothing.pixels.resize(kSize.x * kSize.y);
  RayPassTest test("shadow-rays");
  wire(test, nothing, std::vector<uint64_t>(nothing.pixels.size(), glm::packHalf4x16({1, 2, 3, 0})));
  test.run();
  for (const uint64_t texel : test.values<uint64_t>("direct"))
    ASSERT_EQ(glm::unpackHalf4x16(texel), glm::vec4(1, 2, 3, 1));
}

}  // namespace
}  // namespace fovea::test
