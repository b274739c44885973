// Compares the light of an environment map that near-field rays find with the map's own light.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "framework/scene/environment/environment_map.h"
#include "tests/passes/near_field_run.h"
#include "tests/passes/where_rays_run.h"
#include "tests/support/shapes.h"
#include "tests/support/sky.h"

namespace fovea::test {
namespace {

using Map = std::shared_ptr<const scene::EnvironmentMap>;

// A floor, seen from above.
scene::Scene floorUnder(const Map& map, float rho) {
  scene::Scene s;
  addQuad(s, addMaterial(s, glm::vec3(rho)), {-50, 0, 50}, {100, 0, 0}, {0, 0, -100});
  s.environmentMap = map;
  scene::Camera& camera = s.cameras.emplace_back();
  camera.position = {0, 3, 0};
  camera.orientation = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0));
  return s;
}

class NearFieldEnvironment : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, NearFieldEnvironment, testing::Bool(), nameOfPlace);

glm::dvec3 meanOf(const std::vector<glm::vec4>& image) {
  glm::dvec3 mean(0);
  for (const glm::vec4& texel : image) mean += glm::dvec3(texel) / double(image.size());
  return mean;
}

// Discs of so many square metres on the floor: their share is of the square of its diagonal, as nothing is met there.
void setArea(PassTest& test, double area) {
  constexpr int kVpls = 1 << 20;
  test.param("vpls", kVpls).param("share", area * kVpls / 20000);
}

TEST(NearFieldEnvironmentLight, BringsAllOfItsLight) {
  const Map map = skyWithSun();
  const glm::dvec3 want = irradianceFrom(*map, {0, 1, 0}) / glm::pi<double>();
  for (const double area : {0.05, 5.0}) {
    NearFieldTest test(floorUnder(map, 0), glm::uvec2(16));
    setArea(test, area);
    test.param("first_samples", 256);
    const glm::dvec3 mean = meanOf(test.samples());
    EXPECT_NEAR(test.area(), area, 0.01 * area);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], want[c], 0.01 * want[c]) << area;
  }
}

// Single samples of an open sky hardly differ, though its colours do, as each is a choice among several directions.
TEST(NearFieldEnvironmentLight, OpenSkyHasLittleNoise) {
  std::vector<glm::vec3> texels;  // bright towards one side, and at the horizon
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      texels.emplace_back(float(1 + y) / 8 * (1.2f + std::sin(glm::two_pi<float>() * float(x) / 32)));
  const Map map = std::make_shared<scene::EnvironmentMap>(32, 16, texels);
  NearFieldTest test(floorUnder(map, 0), glm::uvec2(64));
  setArea(test, 1);
  test.param("first_samples", 1);
  const std::vector<glm::vec4> image = test.samples();
  const double mean = meanOf(image).r;
  double square = 0;
  for (const glm::vec4& texel : image) square += double(texel.r) * double(texel.r) / double(image.size());
  EXPECT_NEAR(mean, irradianceFrom(*map, {0, 1, 0}).r / glm::pi<double>(), 0.02 * mean);
  EXPECT_LT(std::sqrt(square / (mean * mean) - 1), 0.4);
}

// On a floor that is alone no ray meets a surface that could say how long rays are.
TEST_P(NearFieldEnvironment, LightsWhatIsAlone) {
  const Map map = skyWithSun();
  NearFieldTest test(floorUnder(map, 0.5f), glm::uvec2(16), GetParam());
  test.param("first_samples", 256);
  const glm::dvec3 want = irradianceFrom(*map, {0, 1, 0}) / glm::pi<double>();
  for (const uint32_t frames : {1, 2}) {  // the second has a ray a sample
    const glm::dvec3 mean = meanOf(test.samples(frames));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], want[c], (frames == 1 ? 0.02 : 0.3) * want[c]) << frames;
  }
}

// Of a roof that faces away from the floor, the back is seen by rays, and is black.
TEST_P(NearFieldEnvironment, DoesNotShineThroughBlackBacks) {
  scene::Scene s =
      floorUnder(std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, glm::vec3(1))), 0.5f);
  s.cameras[0].position.y = 0.5f;
  NearFieldTest open(s, glm::uvec2(16), GetParam());
  EXPECT_NEAR(meanOf(open.samples()).g, 1, 0.05);
  addQuad(s, 0, {-500, 1, 500}, {1000, 0, 0}, {0, 0, -1000});
  NearFieldTest closed(s, glm::uvec2(16), GetParam());
  EXPECT_LT(meanOf(closed.samples()).g, 0.01);
}

// An emissive panel beside the floor, and a map: rays are aimed at both.
TEST_P(NearFieldEnvironment, SharesRaysWithSurfacesThatShine) {
  const Map map = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, glm::vec3(1, 0, 0)));
  scene::Scene s = floorUnder(map, 0);
  const uint32_t panel = addMaterial(s, glm::vec3(0));
  s.materials[panel].emission = {0, 1, 0};
  addQuad(s, panel, {-400, 0, -2}, {800, 0, 0}, {0, 800, 0});
  NearFieldTest test(s, glm::uvec2(16), GetParam());
  test.param("first_samples", 256);
  const glm::dvec3 mean = meanOf(test.samples());
  EXPECT_NEAR(mean.r, 0.5, 0.01);  // each fills half of the hemisphere
  EXPECT_NEAR(mean.g, 0.5, 0.01);
}

// With `light` map, surfaces add nothing: neither the light of a panel beside the floor nor what a lamp leaves on it.
TEST_P(NearFieldEnvironment, ComesAlone) {
  const Map map = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, glm::vec3(1, 2, 3)));
  scene::Scene s = floorUnder(map, 0.5f);
  const uint32_t panel = addMaterial(s, glm::vec3(0.5f));
  s.materials[panel].emission = glm::vec3(20);
  addQuad(s, panel, {-50, 0, -2}, {100, 0, 0}, {0, 50, 0});
  s.lights = {pointLight({0, 2, 0}, glm::vec3(100))};
  NearFieldTest test(s, glm::uvec2(16), GetParam());
  test.param("first_samples", 256);
  test.param("light", "map");
  const glm::dvec3 mean = meanOf(test.samples());  // the panel hides a half or less
  EXPECT_GT(mean.r, 0.5);
  EXPECT_LT(mean.r, 1.0);
  EXPECT_NEAR(mean.g / mean.r, 2, 0.01);
  EXPECT_NEAR(mean.b / mean.r, 3, 0.015);
  NearFieldTest none(s, glm::uvec2(16), GetParam());
  none.param("light", "none");
  EXPECT_EQ(meanOf(none.samples()), glm::dvec3(0));
}

}  // namespace
}  // namespace fovea::test
