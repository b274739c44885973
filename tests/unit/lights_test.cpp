#include "framework/scene/lights.h"

#include <gtest/gtest.h>

#include <vector>

namespace fovea::scene {
namespace {

TEST(Lights, ShadowLayers) {
  std::vector<Light> lights(3);
  lights[0].type = LightType::Point;
  lights[1].type = LightType::Directional;
  lights[2].type = LightType::Spot;
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
