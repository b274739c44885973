// Compares the pixels from which reflections are traced with the plain rule.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <glm/gtc/packing.hpp>

#include "tests/passes/deferred_reference.h"
#include "tests/references/blocks.h"
#include "tests/references/octahedral.h"

namespace fovea::test {
namespace {

constexpr int kWidth = 30, kHeight = 21;

// Rough and smooth columns, the last half of them metal, a row of background and one that reflects nothing.
GBuffer surfaces() {
  return {kWidth, kHeight, raysOnto({0, 0, 0}, {0, 0, -5}, {1, 0, 0}, {0, 1, 0}), [](int x, int y) {
            SurfacePixel p;
            p.position = {float(x), float(y), -5};
            p.distance = y == 3 ? 0.0f : glm::length(p.position);
            p.normal = glm::normalize(glm::vec3(0.1f * float(x), 1, 0.1f * float(y)));
            const float f0 = x < kWidth / 2 ? 0.04f : 0.6f;
            p.specular = glm::vec4(glm::vec3(y == 8 ? 0.0f : f0), 0.1f * float(x % 11));
            return p;
          }};
}

TEST(Mirrors, OnePixelOfEachBlockThatIsSmooth) {
  GBuffer g = surfaces();
  g.full = true;
  int found = 0, rough = 0;
  for (const uint32_t frames : {1u, 2u, 3u, 4u}) {
    PassTest test("mirrors");
    g.wire(test);
    test.run(frames);
    const auto texels = test.values<glm::uvec4>("points");
    const int columns = (kWidth + 1) / 2;
    ASSERT_EQ(int(texels.size()), columns * ((kHeight + 1) / 2));
    for (int i = 0; i < int(texels.size()); ++i) {
      const glm::uvec4 texel = texels[size_t(i)];
      const glm::uvec2 block(i % columns, i / columns), inside = passes::samplePixel(frames - 1, 2, block);
      const glm::ivec2 p(2u * block + inside);
      const bool within = p.x < kWidth && p.y < kHeight;
      const SurfacePixel& pixel = within ? g.at(p.x, p.y) : g.at(0, 3);
      const bool there = pixel.distance > 0 && pixel.specular.r > 0;
      const bool smooth = there && pixel.specular.a < (pixel.specular.r > 0.15f ? 0.85f : 0.45f);
      found += smooth;
      rough += there && !smooth;
      if (!smooth) {
        EXPECT_EQ(texel, glm::uvec4(0)) << i;
        continue;
      }
      EXPECT_EQ(texel.w & 0xffffu, passes::sampleCode(2, inside, true)) << i;
      EXPECT_EQ(texel.x, std::bit_cast<uint32_t>(pixel.distance)) << i;
      EXPECT_NEAR(glm::unpackUnorm2x16(texel.w).y, pixel.specular.a, 1e-3);
      for (const uint32_t normal : {texel.y, texel.z})
        EXPECT_LT(glm::distance(scene::octDecode(glm::unpackSnorm2x16(normal)), pixel.normal), 2e-3f);
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(rough, 100);
}

// Every pixel of a tile counts, be it at its edge or one whose turn it is not, and none of its neighbours.
TEST(Mirrors, TilesInWhichAnyPixelIsSmooth) {
  constexpr int kTile = 16, kColumns = 5, kRows = 3;
  const std::vector<glm::ivec2> smooth{{0, 0}, {31, 15}, {69, 20}, {40, 32}, {48, 39}, {64, 39}};
  GBuffer g(70, 40, raysOnto({0, 0, 0}, {0, 0, -5}, {1, 0, 0}, {0, 1, 0}), [&](int x, int y) {
    SurfacePixel p;
    p.distance = 5;
    p.position = {float(x), float(y), -5};
    p.specular = glm::vec4(glm::vec3(0.04f), std::ranges::count(smooth, glm::ivec2(x, y)) > 0 ? 0.2f : 0.6f);
    return p;
  });
  g.full = true;
  std::vector<uint8_t> want(size_t(kColumns * kRows));
  for (const glm::ivec2 p : smooth) want[size_t(p.y / kTile * kColumns + p.x / kTile)] = 255;
  EXPECT_EQ(std::ranges::count(want, 255), int(smooth.size()));
  for (const uint32_t frames : {1u, 2u, 3u, 4u}) {
    PassTest test("mirrors");
    g.wire(test);
    test.run(frames);
    EXPECT_EQ(test.values<uint8_t>("tiles"), want);
  }
}

// Without full materials the G-buffer knows no reflectance.
TEST(Mirrors, NoneWithDiffuseMaterials) {
  const GBuffer g = surfaces();
  PassTest test("mirrors");
  g.wire(test);
  test.run();
  for (const glm::uvec4& texel : test.values<glm::uvec4>("points")) EXPECT_EQ(texel, glm::uvec4(0));
  for (const uint8_t tile : test.values<uint8_t>("tiles")) EXPECT_EQ(tile, 0);
}

}  // namespace
}  // namespace fovea::test
