#include <gtest/gtest.h>

#include <vector>

#include "fovea/test.h"

namespace fovea::test {
namespace {

// Texels that encode the picture, the column and the row.
std::vector<uint8_t> numbered(uint32_t width, uint32_t height, uint32_t picture) {
  std::vector<uint8_t> texels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      for (const uint32_t value : {picture, x, y, 255u}) texels.push_back(uint8_t(value));
  return texels;
}

TEST(SideBySide, EveryTexelInItsPlace) {
  constexpr uint32_t kLeft = 13, kLeftHeight = 9, kRight = 21, kRightHeight = 5;
  PassTest test("side-by-side");
  test.image("left", VK_FORMAT_R8G8B8A8_UNORM, kLeft, kLeftHeight, 1, numbered(kLeft, kLeftHeight, 1));
  test.image("right", VK_FORMAT_R8G8B8A8_UNORM, kRight, kRightHeight, 1, numbered(kRight, kRightHeight, 2));
  test.run();
  const auto image = test.values<uint8_t>("image");
  ASSERT_EQ(image.size(), size_t(kLeft + kRight) * kLeftHeight * 4);
  for (uint32_t y = 0; y < kLeftHeight; ++y)
    for (uint32_t x = 0; x < kLeft + kRight; ++x) {
      const uint8_t* texel = &image[4 * (size_t(y) * (kLeft + kRight) + x)];
      const bool left = x < kLeft, below = !left && y >= kRightHeight;
      EXPECT_EQ(texel[0], below ? 0 : left ? 1 : 2) << x << ", " << y;
      EXPECT_EQ(texel[1], below ? 0 : left ? x : x - kLeft) << x << ", " << y;
      EXPECT_EQ(texel[2], below ? 0 : y) << x << ", " << y;
      EXPECT_EQ(texel[3], 255) << x << ", " << y;
    }
}

}  // namespace
}  // namespace fovea::test
