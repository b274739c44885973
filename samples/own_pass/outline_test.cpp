// The pass alone, on a surface that turns by 90 degrees in the middle of the picture.
#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <vector>

#include "fovea/test.h"

namespace {

constexpr uint32_t kWidth = 8, kHeight = 4;

// Red of every pixel, with lines of the given strength over a white picture.
std::vector<float> outlined(double strength) {
  fovea::graph::loadPlugin(FOVEA_PLUGIN);
  std::vector<glm::vec4> picture(kWidth * kHeight, glm::vec4(1)), normal;
  const std::vector<float> distance(kWidth * kHeight, 5);
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      normal.push_back(x < kWidth / 2 ? glm::vec4(0, 0, 1, 0) : glm::vec4(1, 0, 0, 0));
    }
  fovea::test::PassTest test("outline");
  test.viewSize(kWidth, kHeight).param("strength", strength);
  test.image("picture", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, picture);
  test.image("gbuffer.distance", VK_FORMAT_R32_SFLOAT, kWidth, kHeight, 1, distance);
  test.image("gbuffer.normal", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, normal);
  test.run();
  const std::vector<float> rgba = test.floats("image");
  std::vector<float> red;
  for (size_t i = 0; i < rgba.size(); i += 4) red.push_back(rgba[i]);
  return red;
}

TEST(Outline, DrawsALineWhereTheSurfaceTurnsAndNowhereElse) {
  const std::vector<float> red = outlined(0.8);
  ASSERT_EQ(red.size(), kWidth * kHeight);
  for (uint32_t i = 0; i < red.size(); ++i)
    EXPECT_NEAR(red[i], i % kWidth == kWidth / 2 - 1 ? 0.2f : 1.0f, 0.5f / 255) << "pixel " << i;
}

TEST(Outline, WithoutStrengthThePictureStaysAsItIs) {
  for (const float red : outlined(0)) EXPECT_EQ(red, 1);
}

}  // namespace
