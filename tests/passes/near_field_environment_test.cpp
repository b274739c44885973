// Compares the light of an environment map that near-field rays find with the map's own light.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "fovea/test.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/frame.h"
#include "passes/near-field/near_field_tracer.h"
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

// Samples of a black floor in a picture of so many pixels, in blocks of 2 x 2.
std::vector<glm::vec4> samplesUnder(const Map& map, uint32_t side, float area, uint32_t samples) {
  const scene::Scene s = floorUnder(map, 0);
  const scene::Geometry geometry = scene::flatten(s);
  const scene::RayScene rays(s, geometry);
  const scene::Frame frame = scene::makeFrame(s, geometry, glm::uvec2(side), 0, 1);
  passes::NearFieldSettings settings;
  settings.foveaRadius = 2;
  settings.area = area;
  settings.samples = samples;
  std::vector<glm::vec4> image(size_t(side * side / 4));
  passes::traceNearField(frame, frame.views[0], rays, settings, image);
  return image;
}

glm::dvec3 meanOf(const std::vector<glm::vec4>& image) {
  glm::dvec3 mean(0);
  for (const glm::vec4& texel : image) mean += glm::dvec3(texel) / double(image.size());
  return mean;
}

TEST(NearFieldEnvironment, BringsAllOfItsLight) {
  const Map map = skyWithSun();
  const glm::dvec3 want = irradianceFrom(*map, {0, 1, 0}) / glm::pi<double>();
  for (const float area : {0.05f, 5.0f}) {
    const glm::dvec3 mean = meanOf(samplesUnder(map, 16, area, 1024));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], want[c], 0.01 * want[c]) << area;
  }
}

// Single samples of an open sky hardly differ, though its colours do, as each is a choice among several directions.
TEST(NearFieldEnvironment, OpenSkyHasLittleNoise) {
  std::vector<glm::vec3> texels;  // bright towards one side, and at the horizon
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      texels.emplace_back(float(1 + y) / 8 * (1.2f + std::sin(glm::two_pi<float>() * float(x) / 32)));
  const Map map = std::make_shared<scene::EnvironmentMap>(32, 16, texels);
  const std::vector<glm::vec4> image = samplesUnder(map, 64, 1, 1);
  const double mean = meanOf(image).r;
  double square = 0;
  for (const glm::vec4& texel : image) square += double(texel.r) * double(texel.r) / double(image.size());
  EXPECT_NEAR(mean, irradianceFrom(*map, {0, 1, 0}).r / glm::pi<double>(), 0.02 * mean);
  EXPECT_LT(std::sqrt(square / (mean * mean) - 1), 0.4);
}

// Rays on the host and on the device.
class NearFieldMaps : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Tracers, NearFieldMaps, testing::Values("near-field-host", "near-field-device"),
                         [](const auto& test) { return std::string(test.param).substr(11); });

glm::dvec3 lightOf(PassTest& test, uint32_t frames) {
  test.run(frames);
  const std::vector<float> light = test.floats("samples");
  glm::dvec3 mean(0);
  for (size_t i = 0; i < light.size(); i += 4)
    mean += 4.0 * glm::dvec3(light[i], light[i + 1], light[i + 2]) / double(light.size());
  return mean;
}

// On a floor that is alone no ray meets a surface that could say how long rays are.
TEST_P(NearFieldMaps, LightsWhatIsAlone) {
  const Map map = skyWithSun();
  PassTest test(GetParam());
  test.viewSize(16, 16).scene(floorUnder(map, 0.5f)).view("fovea_radius", 2.0).param("first_samples", 1024);
  const glm::dvec3 want = irradianceFrom(*map, {0, 1, 0}) / glm::pi<double>();
  for (const uint32_t frames : {1, 2}) {  // the second has a ray a sample
    const glm::dvec3 mean = lightOf(test, frames);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], want[c], (frames == 1 ? 0.02 : 0.3) * want[c]) << frames;
  }
}

// An emissive panel beside the floor, and a map: rays are aimed at both.
TEST_P(NearFieldMaps, SharesRaysWithSurfacesThatShine) {
  const Map map = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, glm::vec3(1, 0, 0)));
  scene::Scene s = floorUnder(map, 0);
  const uint32_t panel = addMaterial(s, glm::vec3(0));
  s.materials[panel].emission = {0, 1, 0};
  addQuad(s, panel, {-400, 0, -2}, {800, 0, 0}, {0, 800, 0});
  PassTest test(GetParam());
  test.viewSize(16, 16).scene(s).view("fovea_radius", 2.0).param("first_samples", 1024);
  const glm::dvec3 mean = lightOf(test, 1);
  EXPECT_NEAR(mean.r, 0.5, 0.01);  // each fills half of the hemisphere
  EXPECT_NEAR(mean.g, 0.5, 0.01);
}

// With `light` map, surfaces add nothing: neither the light of a panel beside the floor nor what a lamp leaves on it.
TEST_P(NearFieldMaps, ComesAlone) {
  const Map map = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, glm::vec3(1, 2, 3)));
  scene::Scene s = floorUnder(map, 0.5f);
  const uint32_t panel = addMaterial(s, glm::vec3(0.5f));
  s.materials[panel].emission = glm::vec3(20);
  addQuad(s, panel, {-50, 0, -2}, {100, 0, 0}, {0, 50, 0});
  s.lights = {pointLight({0, 2, 0}, glm::vec3(100))};
  PassTest test(GetParam());
  test.viewSize(16, 16).scene(s).view("fovea_radius", 2.0).param("first_samples", 1024);
  test.param("light", "map");
  const glm::dvec3 mean = lightOf(test, 1);  // the panel hides a half or less
  EXPECT_GT(mean.r, 0.5);
  EXPECT_LT(mean.r, 1.0);
  EXPECT_NEAR(mean.g / mean.r, 2, 0.01);
  EXPECT_NEAR(mean.b / mean.r, 3, 0.015);
  PassTest none(GetParam());
  none.viewSize(16, 16).scene(s).param("light", "none");
  EXPECT_EQ(lightOf(none, 1), glm::dvec3(0));
}

}  // namespace
}  // namespace fovea::test
