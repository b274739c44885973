#include "framework/scene/device/texture_pages.h"

#include <gtest/gtest.h>

#include <bit>

#include "fovea/error.h"
#include "framework/base/random.h"

namespace fovea::scene {
namespace {

void expectValid(const TexturePages& pages, const std::vector<glm::uvec2>& sizes) {
  ASSERT_EQ(pages.places.size(), sizes.size());
  for (size_t i = 0; i < sizes.size(); ++i) {
    const auto& a = pages.places[i];
    ASSERT_LT(a.page, pages.pages);
    ASSERT_LE(a.x + sizes[i].x, pages.side);
    ASSERT_LE(a.y + sizes[i].y, pages.side);
    for (size_t j = 0; j < i; ++j) {
      const auto& b = pages.places[j];
      const bool apart = a.page != b.page || a.x + sizes[i].x <= b.x || b.x + sizes[j].x <= a.x ||
                         a.y + sizes[i].y <= b.y || b.y + sizes[j].y <= a.y;
      ASSERT_TRUE(apart) << "textures " << i << " and " << j << " overlap";
    }
  }
}

TEST(TexturePages, RandomSetsNeverOverlap) {
  for (uint32_t set = 0; set < 50; ++set) {
    std::vector<glm::uvec2> sizes(1 + hashPcg(set) % 60);
    for (uint32_t i = 0; i < sizes.size(); ++i)
      sizes[i] = {1 + hashCombine(set, 2 * i) % 700, 1 + hashCombine(set, 2 * i + 1) % 300};
    expectValid(packTextures(sizes, 16384), sizes);
    expectValid(packTextures(sizes, 700), sizes);
  }
}

TEST(TexturePages, EqualPowersOfTwoFillTheirPages) {
  const std::vector<glm::uvec2> sizes(64, glm::uvec2(1024));
  const TexturePages pages = packTextures(sizes, 16384);
  expectValid(pages, sizes);
  EXPECT_EQ(uint64_t(pages.side) * pages.side * pages.pages, 64ull * 1024 * 1024);
}

TEST(TexturePages, NoTextureIsOneTexel) {
  const TexturePages pages = packTextures({}, 4096);
  EXPECT_EQ(pages.side, 1u);
  EXPECT_EQ(pages.pages, 1u);
}

TEST(TexturePages, LimitsAreKept) {
  EXPECT_EQ(packTextures({{1500, 3}}, 1500).side, 1500u);  // not rounded past the limit
  EXPECT_THROW(packTextures({{1501, 3}}, 1500), Error);
  EXPECT_THROW(packTextures({{0, 3}}, 1500), Error);
}

}  // namespace
}  // namespace fovea::scene
