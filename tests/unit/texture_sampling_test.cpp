// Compares sampleTexture with values worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/scene/scene.h"

namespace fovea::scene {
namespace {

double decode(int v) {
  const double e = v / 255.0;
  return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
}

// 4 x 2 texels; the red of texel (x, y) is 10 + 60 x + 20 y.
Scene scene(bool srgb) {
  Scene s;
  Texture t;
  t.width = 4;
  t.height = 2;
  t.srgb = srgb;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x)
      t.rgba.insert(t.rgba.end(), {uint8_t(10 + 60 * x + 20 * y), 0, 0, uint8_t(50 * x)});
  s.textures.push_back(t);
  return s;
}

TextureUse use(Wrap u = Wrap::Repeat, Wrap v = Wrap::Repeat) {
  TextureUse t;
  t.texture = 0;
  t.wrapU = u;
  t.wrapV = v;
  return t;
}

TEST(TextureSampling, TexelCentresGiveTheTexelFromTheTopLeft) {
  const Scene s = scene(true);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) {
      const glm::vec4 c = sampleTexture(s, use(), {(x + 0.5f) / 4, (y + 0.5f) / 2});
      EXPECT_NEAR(c.r, decode(10 + 60 * x + 20 * y), 1e-6) << x << ' ' << y;
      EXPECT_NEAR(c.a, 50 * x / 255.0, 1e-6);
    }
}

TEST(TextureSampling, DecodesBeforeItFiltersAndNeverDecodesAlpha) {
  const glm::vec4 c = sampleTexture(scene(true), use(), {0.375f, 0.25f});  // the centre of texel 1
  EXPECT_NEAR(c.r, decode(70), 1e-6);
  const glm::vec4 middle = sampleTexture(scene(true), use(), {0.5f, 0.25f});
  EXPECT_NEAR(middle.r, 0.5 * (decode(70) + decode(130)), 1e-6);
  EXPECT_NEAR(middle.a, 0.5 * (50 + 100) / 255.0, 1e-6);
  const glm::vec4 linear = sampleTexture(scene(false), use(), {0.5f, 0.25f});
  EXPECT_NEAR(linear.r, 100 / 255.0, 1e-6);
}

TEST(TextureSampling, BilinearInBothDirections) {
  // A quarter of the way from texel (1, 0) to (2, 0), three quarters from row 0 to row 1.
  const glm::vec4 c = sampleTexture(scene(false), use(), {(1.5f + 0.25f) / 4, (0.5f + 0.75f) / 2});
  EXPECT_NEAR(c.r, (10 + 60 * 1.25 + 20 * 0.75) / 255.0, 1e-6);
}

TEST(TextureSampling, NearestTexelsHaveHardEdges) {
  const Scene s = scene(false);
  TextureUse t = use(Wrap::Clamp, Wrap::Repeat);
  t.nearest = true;
  for (int i = -4; i < 44; ++i) {
    const float u = (float(i) + 0.5f) / 40;
    EXPECT_FLOAT_EQ(sampleTexture(s, t, {u, 0.4f}).r * 255, float(10 + 60 * std::clamp(i / 10, 0, 3))) << u;
    EXPECT_FLOAT_EQ(sampleTexture(s, t, {u, 0.6f}).r * 255, float(30 + 60 * std::clamp(i / 10, 0, 3))) << u;
  }
  EXPECT_FLOAT_EQ(sampleTexture(s, t, {0.1f, -0.1f}).r * 255, 30);  // repeats
  EXPECT_FLOAT_EQ(sampleTexture(s, t, {0.26f, 0.1f}).a * 255, 50);
}

TEST(TextureSampling, WrapModes) {
  const Scene s = scene(false);
  const auto red = [&](Wrap w, float u) { return sampleTexture(s, use(w), {u, 0.25f}).r * 255.0f; };
  // At u = 0 the sample lies between texel 0 and the one to its left.
  EXPECT_NEAR(red(Wrap::Repeat, 0), 0.5f * (10 + 190), 1e-3f);
  EXPECT_NEAR(red(Wrap::Clamp, 0), 10, 1e-3f);
  EXPECT_NEAR(red(Wrap::Mirror, 0), 10, 1e-3f);
  EXPECT_NEAR(red(Wrap::Repeat, 1.125f), 10, 1e-3f);
  EXPECT_NEAR(red(Wrap::Clamp, 1.125f), 190, 1e-3f);
  EXPECT_NEAR(red(Wrap::Mirror, 1.125f), 190, 1e-3f);
  EXPECT_NEAR(red(Wrap::Mirror, 1.375f), 130, 1e-3f);
  EXPECT_NEAR(red(Wrap::Repeat, -0.125f), 190, 1e-3f);
  EXPECT_NEAR(red(Wrap::Clamp, -5.0f), 10, 1e-3f);
  EXPECT_NEAR(red(Wrap::Mirror, -0.375f), 70, 1e-3f);
  EXPECT_NEAR(red(Wrap::Mirror, 2.125f), 10, 1e-3f);
}

TEST(TextureSampling, WrapsPerDirection) {
  const TextureUse t = use(Wrap::Repeat, Wrap::Clamp);
  const Scene s = scene(false);
  EXPECT_NEAR(sampleTexture(s, t, {1.125f, 1.75f}).r * 255, 10 + 20, 1e-3f);
}

TEST(TextureSampling, TransformComesFirst) {
  TextureUse t = use();
  t.transform = glm::mat3x2(0, 1, 2, 0, 0.25f, 0);  // u' = 2 v + 0.25, v' = u
  const Scene s = scene(false);
  EXPECT_NEAR(sampleTexture(s, t, {0.25f, 0.0625f}).r * 255, sampleTexture(s, use(), {0.375f, 0.25f}).r * 255,
              1e-4f);
}

TEST(TextureSampling, AnyCoordinateIsSafe) {
  const Scene s = scene(true);
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const Wrap w : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
    for (const float u : {inf, -inf, nan, 1e30f, -1e30f, 3e9f, -3e9f}) {
      const glm::vec4 c = sampleTexture(s, use(w, w), {u, u});
      EXPECT_GE(c.r, 0);
      EXPECT_LE(c.r, 1);
    }
}

TEST(TextureSampling, NoTextureIsWhite) {
  Scene s;
  EXPECT_EQ(sampleTexture(s, {}, {0.5f, 0.5f}), glm::vec4(1));
  Material m;
  m.baseColor = {0.5f, 0.25f, 1, 0.5f};
  m.metallic = 0.5f;
  m.emission = {1, 2, 3};
  EXPECT_EQ(reflectance(s, m, {0, 0}), glm::vec4(0.25f, 0.125f, 0.5f, 0.5f));
  EXPECT_EQ(emission(s, m, {0, 0}), glm::vec3(1, 2, 3));
}

}  // namespace
}  // namespace fovea::scene
