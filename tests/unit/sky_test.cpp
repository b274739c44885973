// The analytic sky, against values computed by hand from the formulas of Preetham, Shirley and Smits 1999.
#include "framework/scene/environment/sky.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOf;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

Scene loadJson(const TemporaryFolder& folder, const std::string& text, Diagnostics& warnings) {
  return load(folder.write("scene.json", text).string(), warnings);
}

float radians(float degrees) { return glm::radians(degrees); }

void expectColor(glm::vec3 color, float x, float y, float luminance) {
  EXPECT_NEAR(color.x, x, 1e-4);
  EXPECT_NEAR(color.y, y, 1e-4);
  EXPECT_NEAR(color.z, luminance, 2e-3);
}

TEST(Sky, ZenithIsThatOfThePaper) {
  // Turbidity 2 and the sun in the zenith: chi = (4/9 - 1/60) pi = 1.34390, its tangent 4.3315; Y = 3.1196 * 4.3315
  // - 0.4310 + 2.4192. Of x and y only the last column is left: 4 * 0.11693 ... = 0.26674.
  expectColor(zenithColor(2, 0), 0.26674f, 0.27720f, 15.5007f);
  expectColor(zenithColor(3, radians(50)), 0.24441f, 0.25052f, 6.5250f);
  expectColor(zenithColor(6, radians(70)), 0.27145f, 0.28981f, 6.5797f);
}

TEST(Sky, DirectionsFollowPerez) {
  expectColor(skyColor(3, radians(50), radians(60), radians(30)), 0.27166f, 0.27964f, 14.3669f);
  expectColor(skyColor(3, radians(50), radians(80), radians(120)), 0.27909f, 0.29589f, 7.4521f);
  // The zenith itself.
  expectColor(skyColor(3, radians(50), 0, radians(50)), 0.24441f, 0.25052f, 6.5250f);
}

TEST(Sky, WhiteOfTheDisplayIsItsWhite) {
  const glm::vec3 white = linearFromXyY({0.31271f, 0.32902f, 2});  // D65
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 2, 2e-3);
}

TEST(Sky, SunIsRedderWhenItIsLowAndDimmerInHaze) {
  const glm::vec3 high = sunlight(3, radians(20)), low = sunlight(3, radians(80)),
                  hazy = sunlight(6, radians(20));
  EXPECT_NEAR(high.g, 90, 1);  // klx
  EXPECT_LT(low.g, high.g);
  EXPECT_GT(low.r / low.b, 1.5f * high.r / high.b);
  EXPECT_LT(hazy.g, 0.8f * high.g);
}

// Sun and sky together light level ground as asked, below the horizon lies the light that the ground reflects of it,
// and no direction is black or not a number, whatever the haze and the sun.
TEST(Sky, IntegralIsTheIlluminanceAskedFor) {
  for (const float turbidity : {2.0f, 3.0f, 6.0f, 10.0f})
    for (const float elevation : {0.0f, 3.0f, 40.0f, 90.0f}) {
      Sky sky;
      sky.turbidity = turbidity;
      sky.sunElevation = radians(elevation);
      sky.sunAzimuth = radians(70);
      sky.illuminance = 5;
      sky.ground = {0.3f, 0.2f, 0.1f};
      const Daylight light = daylight(sky);
      const EnvironmentMap& map = *light.map;
      glm::dvec3 onGround = double(towardsSun(sky).y) * glm::dvec3(light.sun);
      constexpr int kRows = 128;
      for (int i = 0; i < kRows; ++i)
        for (int j = 0; j < 2 * kRows; ++j) {  // equal shares of the upper half of the sphere
          const double y = (i + 0.5) / kRows, phi = (j + 0.5) * glm::pi<double>() / kRows;
          const double across = std::sqrt(1 - y * y);
          const glm::vec3 d(across * std::cos(phi), y, across * std::sin(phi));
          onGround += y * glm::dvec3(map.radiance(d)) * glm::two_pi<double>() / double(2 * kRows * kRows);
        }
      EXPECT_NEAR((onGround.r + onGround.g + onGround.b) / 3, 5, 0.05) << turbidity << " " << elevation;
      for (const glm::vec3& t : map.texels()) {
        ASSERT_GT(t.r + t.g + t.b, 0) << turbidity << " " << elevation;
        for (int c = 0; c < 3; ++c) {
          ASSERT_TRUE(std::isfinite(t[c]));
          ASSERT_GE(t[c], 0);  // 0 where the display cannot show so deep a blue
        }
      }
      const glm::vec3 below = map.radiance({0, -1, 0});
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(below[c], sky.ground[c] * onGround[c] / glm::pi<double>(), 0.01 * double(below[c]));
      EXPECT_LT(glm::distance(below, map.radiance(glm::normalize(glm::vec3(1, -0.1f, 0.3f)))), 1e-6f);
    }
}

TEST(Sky, IsBrightestAroundTheSun) {
  Sky sky;
  sky.sunElevation = radians(30);
  sky.sunAzimuth = radians(90);  // counter-clockwise from -Z, seen from above: above -X
  const glm::vec3 sun = towardsSun(sky);
  EXPECT_LT(glm::distance(sun, {-std::cos(radians(30)), 0.5f, 0}), 1e-5f);
  const Daylight light = daylight(sky);
  EXPECT_GT(light.map->radiance(sun).g, 3 * light.map->radiance({-sun.x, sun.y, 0}).g);
  EXPECT_GT(light.map->radiance({0, 1, 0}).b, light.map->radiance({0, 1, 0}).r);  // the zenith is blue
}

TEST(Sky, IsAValueOfSceneFiles) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const Scene s = loadJson(folder, R"({
    "models": [{ "builtin": "cornellbox", "lights": false }],
    "environment": { "sky": { "turbidity": 4, "sun_elevation_deg": 30, "sun_azimuth_deg": 45, "illuminance": 7,
                              "ground": [0.1, 0.2, 0.3] } }
  })",
                           warnings);
  Sky sky{4, radians(30), radians(45), 7, {0.1f, 0.2f, 0.3f}};
  const Daylight light = daylight(sky);
  ASSERT_TRUE(s.environmentMap);
  EXPECT_EQ(s.environmentMap->texels(), light.map->texels());
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.lights[0].color * s.lights[0].intensity, light.sun);
  EXPECT_EQ(s.lights[0].direction, -towardsSun(sky));

  const Scene veiled = loadJson(folder, R"({
    "models": [{ "builtin": "cornellbox", "lights": false }], "environment": { "sky": { "sun": false } } })",
                                warnings);
  EXPECT_TRUE(veiled.lights.empty());
}

TEST(Sky, MistakesInSceneFilesAreNamed) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const auto error = [&](const std::string& environment) {
    return errorOf([&] {
      loadJson(folder, R"({"models": [{"builtin": "cornellbox"}], "environment": )" + environment + "}",
               warnings);
    });
  };
  EXPECT_THAT(error(R"({"sky": {"turbidity": 1}})"),
              AllOf(HasSubstr("environment.sky.turbidity"), HasSubstr("2")));
  EXPECT_THAT(error(R"({"sky": {"sun_elevation_deg": 95}})"), HasSubstr("environment.sky.sun_elevation_deg"));
  EXPECT_THAT(error(R"({"sky": {"sun_elevation": 30}})"), HasSubstr("did you mean `sun_elevation_deg`"));
  EXPECT_THAT(error(R"({"sky": {"ground": [2, 0, 0]}})"), HasSubstr("environment.sky.ground"));
  EXPECT_THAT(error(R"({"sky": 3})"), HasSubstr("environment.sky"));
  EXPECT_THAT(error(R"({"sky": {}, "file": "a.exr"})"), HasSubstr("either by `file` or by `sky`"));
}

}  // namespace
}  // namespace fovea::scene
