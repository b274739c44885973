// Tests environment maps: the equirectangular mapping, and what images may hold.
#include "framework/scene/environment/environment_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "fovea/image.h"
#include "framework/base/random.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::errorOf;
using test::TemporaryFolder;
using testing::HasSubstr;

glm::vec3 directionAt(double u, double v) {  // of a place in the picture
  const double phi = (u - 0.5) * glm::two_pi<double>(), theta = v * glm::pi<double>();
  return glm::vec3(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
}

TEST(EnvironmentMap, MiddleLiesAheadAndTheUpperEdgeAbove) {
  std::vector<glm::vec3> texels(8 * 4, glm::vec3(0));
  const auto at = [&](uint32_t x, uint32_t y) -> glm::vec3& { return texels[y * 8 + x]; };
  for (uint32_t x = 0; x < 8; ++x) at(x, 0) = {0, 0, 1};
  at(3, 1) = at(4, 1) = at(3, 2) = at(4, 2) = {1, 0, 0};  // ahead
  at(5, 1) = at(6, 1) = at(5, 2) = at(6, 2) = {0, 1, 0};  // to the right
  const EnvironmentMap map(8, 4, texels), turned(8, 4, texels, glm::half_pi<float>());
  EXPECT_EQ(map.radiance({0, 0, -1}), glm::vec3(1, 0, 0));
  EXPECT_EQ(map.radiance({1, 0, 0}), glm::vec3(0, 1, 0));
  EXPECT_EQ(map.radiance({0, 1, 0}), glm::vec3(0, 0, 1));
  EXPECT_EQ(map.radiance({0, -1, 0}), glm::vec3(0));
  // Counter-clockwise from above: what was to the right is ahead, and what was ahead is to the left.
  EXPECT_LT(glm::distance(turned.radiance({0, 0, -1}), {0, 1, 0}), 1e-5f);
  EXPECT_LT(glm::distance(turned.radiance({-1, 0, 0}), {1, 0, 0}), 1e-5f);
}

TEST(EnvironmentMap, IsInterpolatedAlsoAcrossItsSeam) {
  std::vector<glm::vec3> texels(4 * 2, glm::vec3(0));
  texels[0] = texels[4] = glm::vec3(8);
  const EnvironmentMap map(4, 2, texels);
  EXPECT_NEAR(map.radiance(directionAt(0, 0.5)).r, 4, 1e-4);  // halfway between the last column and the first
  EXPECT_NEAR(map.radiance(directionAt(0.125, 0.5)).r, 8, 1e-4);   // the middle of the first
  EXPECT_NEAR(map.radiance(directionAt(0.1875, 0.5)).r, 6, 1e-4);  // a quarter of the way to the second
}

TEST(EnvironmentMap, BlackAndBrokenTexelsSendNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const EnvironmentMap map(2, 1, {{nan, inf, -1}, {0, -inf, nan}});
  EXPECT_EQ(map.radiance({1, 0, 0}), glm::vec3(0));
}

TEST(EnvironmentMap, IsReadFromAnImageTwiceAsWideAsHigh) {
  TemporaryFolder folder;
  const auto write = [&](const char* name, uint32_t width, uint32_t height) {
    image::Image picture{width, height, 3, {}};
    for (uint32_t i = 0; i < width * height; ++i)
      picture.data.insert(picture.data.end(), {1, float(i), 0.5f});
    image::write(folder.path() / name, {{"", picture}});
    return folder.path() / name;
  };
  const auto map = loadEnvironment(write("sky.exr", 4, 2), 2, 0.25f);
  EXPECT_EQ(map->texels().at(5), glm::vec3(2, 10, 1));
  EXPECT_EQ(map->turn(), 0.25f);
  const std::string message = errorOf([&] { loadEnvironment(write("square.exr", 4, 4), 1, 0); });
  EXPECT_THAT(message, HasSubstr("square.exr"));
  EXPECT_THAT(message, HasSubstr("twice as wide as high"));
  EXPECT_THAT(errorOf([&] { loadEnvironment(folder.path() / "none.exr", 1, 0); }), HasSubstr("none.exr"));
}

}  // namespace
}  // namespace fovea::scene
