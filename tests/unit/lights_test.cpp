#include "framework/scene/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fovea::scene {
namespace {

Light makeLight(LightType type) {
  Light light;
  light.type = type;
  light.color = {1, 0.5f, 0.25f};
  light.intensity = 8;
  light.position = {1, 2, 3};
  light.direction = {0, -1, 0};
  light.innerConeAngle = 0.2f;
  light.outerConeAngle = 0.6f;
  return light;
}

void expectNear(glm::vec3 a, glm::vec3 b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST(Lights, DirectionalIsTheSameEverywhere) {
  const Light light = makeLight(LightType::Directional);
  for (const glm::vec3 p : {glm::vec3(0), glm::vec3(100, -5, 7)}) {
    const LightSample s = sampleLight(light, p);
    expectNear(s.irradiance, {8, 4, 2}, 0);
    expectNear(s.direction, {0, 1, 0}, 0);
    EXPECT_EQ(s.distance, kFarAway);
  }
}

TEST(Lights, PointFallsWithTheSquareOfTheDistance) {
  const Light light = makeLight(LightType::Point);
  const LightSample s = sampleLight(light, {1, 2, 5});
  expectNear(s.irradiance, {2, 1, 0.5f}, 1e-6f);
  expectNear(s.direction, {0, 0, -1}, 1e-6f);
  EXPECT_FLOAT_EQ(s.distance, 2);
  // On the light itself the value is large, but finite.
  EXPECT_TRUE(std::isfinite(sampleLight(light, light.position).irradiance.x));
}

// The flux through a sphere around a point light is 4 pi I, whatever the radius (midpoint rule over the sphere).
TEST(Lights, FluxOfPointAndSpotMatchesTheClosedForm) {
  for (const LightType type : {LightType::Point, LightType::Spot}) {
    const Light light = makeLight(type);
    for (const float radius : {0.1f, 3.0f}) {
      double flux = 0;
      constexpr int kRings = 4000;
      for (int i = 0; i < kRings; ++i) {
        const double z = -1 + 2 * (i + 0.5) / kRings, r = std::sqrt(1 - z * z);
        const glm::vec3 outward(float(r), float(z), 0);  // rotational symmetry about the y axis
        flux += sampleLight(light, light.position + radius * outward).irradiance.x;
      }
      flux *= 4 * glm::pi<double>() * radius * radius / kRings;
      const double ci = std::cos(0.2), co = std::cos(0.6);
      const double expected = type == LightType::Point
                                  ? 8 * 4 * glm::pi<double>()
                                  : 8 * 2 * glm::pi<double>() * ((1 - ci) + (ci - co) / 3);
      EXPECT_NEAR(flux / expected, 1, 2e-3) << "radius " << radius;
    }
  }
}

TEST(Lights, SpotFalloff) {
  const Light light = makeLight(LightType::Spot);
  const auto at = [&](float angle) {  // 1 m away, `angle` off the axis
    return sampleLight(light, light.position + glm::vec3(std::sin(angle), -std::cos(angle), 0)).irradiance.x;
  };
  EXPECT_NEAR(at(0), 8, 1e-4);
  EXPECT_NEAR(at(0.19f), 8, 1e-4);
  EXPECT_EQ(at(0.61f), 0);
  EXPECT_EQ(at(3.0f), 0);
  const double s = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
  EXPECT_NEAR(at(0.4f), 8 * s * s, 1e-4);
}

TEST(Lights, EqualConeAnglesGiveAnEdgeNotNan) {
  Light light = makeLight(LightType::Spot);
  light.innerConeAngle = light.outerConeAngle = 0.5f;
  EXPECT_NEAR(sampleLight(light, light.position + glm::vec3(0, -1, 0)).irradiance.x, 8, 1e-4);
  EXPECT_EQ(sampleLight(light, light.position + glm::vec3(1, -1, 0)).irradiance.x, 0);
}

TEST(Lights, RangeWindowOnlyWithARange) {
  Light light = makeLight(LightType::Point);
  const glm::vec3 p = light.position + glm::vec3(2, 0, 0);
  EXPECT_FLOAT_EQ(sampleLight(light, p).irradiance.x, 2);
  light.range = 4;
  EXPECT_FLOAT_EQ(sampleLight(light, p).irradiance.x, 2 * (1 - 1 / 16.f));
  light.range = 1.9f;
  EXPECT_EQ(sampleLight(light, p).irradiance.x, 0);
}

TEST(Lights, ShadowLayers) {
  const std::vector<Light> lights{makeLight(LightType::Point), makeLight(LightType::Directional),
                                  makeLight(LightType::Spot)};
  EXPECT_EQ(shadowLayers(lights[0]), 6u);
  EXPECT_EQ(shadowLayers(lights), 8u);
  EXPECT_EQ(shadowLayers(std::span<const Light>()), 0u);
}

// All maps together have no more than 2^27 texels, and nearly as many.
TEST(Lights, MostShadowTexels) {
  EXPECT_EQ(mostShadowTexels(0), 11585u);
  EXPECT_EQ(mostShadowTexels(1), 11585u);
  EXPECT_EQ(mostShadowTexels(32), 2048u);
  EXPECT_EQ(mostShadowTexels(33), 2016u);
  EXPECT_EQ(mostShadowTexels(576), 482u);
}

}  // namespace
}  // namespace fovea::scene
