// Tests the shading of listed blocks only, with known irradiance elsewhere: the light is the same as without a mask,
// there are no seams, and the cost depends on the number of blocks.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "tests/passes/deferred_scenes.h"

namespace fovea::test {
namespace {

using scene::Vpl;

float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(23, 0, what, i)); }

// VPLs over a floor of +-2 m, each with a different strength.
std::vector<Vpl> randomVpls(uint32_t count) {
  std::vector<Vpl> list(count);
  for (uint32_t i = 0; i < count; ++i) {
    list[i].position = {6 * random(0, i) - 3, 1.5f + 2 * random(1, i), 6 * random(2, i) - 3};
    list[i].normal = glm::normalize(glm::vec3(random(3, i) - 0.5f, -1, random(4, i) - 0.5f));
    list[i].intensity = glm::vec3(random(5, i), random(6, i), random(7, i)) * 100.0f / float(count);
    list[i].area = 0.1f;
  }
  return list;
}

// Patches at different depths, tilted, with holes to the background.
GBuffer makePatches(int width, int height) {
  return GBuffer(
      width, height, raysOnto({0, 4, 0}, {-0.5f, 0, -0.4f}, {0.02f, 0, 0}, {0, 0, 0.02f}), [](int x, int y) {
        const uint32_t patch = uint32_t(x / 9 + 8 * (y / 7)), pixel = uint32_t(x + 64 * y);
        SurfacePixel p;
        p.distance = random(30, patch) < 0.15f ? 0.0f : 3 + random(31, patch);
        p.position = {0.02f * float(x) - 0.5f, 0.5f * random(32, patch) + 0.004f * random(33, pixel),
                      0.02f * float(y) - 0.4f};
        p.normal = glm::normalize(glm::vec3(random(34, patch) - 0.5f, 1, random(35, patch) - 0.5f));
        return p;
      });
}

// The blocks of n x n pixels that `listed` names, in the form in which pass reproject writes them.
struct Mask {
  int n;
  std::vector<uint8_t> pixels;
  std::vector<uint32_t> blocks;
  uint32_t count = 0;

  Mask(const GBuffer& g, int size, const std::function<bool(int, int)>& listed)
      : n(size),
        pixels(g.pixels.size()),
        blocks(size_t((g.width + n - 1) / n * ((g.height + n - 1) / n)), ~0u) {
    for (int y = 0; y < (g.height + n - 1) / n; ++y)
      for (int x = 0; x < (g.width + n - 1) / n; ++x)
        if (listed(x, y)) blocks[count++] = uint32_t(x | y << 16);
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) pixels[size_t(y * g.width + x)] = listed(x / n, y / n) ? 1 : 0;
  }

  void wire(PassTest& test, const GBuffer& g) const {
    std::vector<uint8_t> unorm;
    for (uint8_t p : pixels) unorm.push_back(p ? 255 : 0);
    struct Dispatch {
      uint32_t groups[3], blocks;
    };
    test.image("shade.mask", VK_FORMAT_R8_UNORM, uint32_t(g.width), uint32_t(g.height), 1, unorm);
    test.buffer("shade.blocks", blocks, "ShadeBlock");
    test.buffer("shade.dispatch", std::vector<Dispatch>{{{(count + 255) / 256, uint32_t(n * n), 1}, count}},
                "ShadeDispatch");
  }
};

// In the form in which pass reproject writes it: 0 in the background.
void wireBase(PassTest& test, const GBuffer& g, const std::vector<glm::vec3>& base) {
  std::vector<uint16_t> half;
  for (size_t i = 0; i < base.size(); ++i) {
    const glm::vec3 v = g.pixels[i].distance > 0 ? base[i] : glm::vec3(0);
    for (const float x : {v.r, v.g, v.b, 1.0f}) half.push_back(glm::packHalf1x16(x));
  }
  test.image("base", VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(g.width), uint32_t(g.height), 1, half);
}

std::vector<glm::vec3> colors(const std::vector<float>& rgba) {
  std::vector<glm::vec3> result;
  for (size_t i = 0; i < rgba.size(); i += 4) result.emplace_back(rgba[i], rgba[i + 1], rgba[i + 2]);
  return result;
}

std::vector<float> run(PassTest& test, const GBuffer& g, const std::vector<Vpl>& vpls, int interleave,
                       const Mask* mask = nullptr, const std::vector<glm::vec3>& base = {}) {
  g.wire(test);
  if (mask) mask->wire(test, g);
  if (mask) wireBase(test, g, base);
  test.buffer("vpls", vpls, "Vpl").param("interleave", interleave);
  test.run();
  return test.floats("irradiance");
}

// With every block listed, the result is bit for bit that of the pass without a mask, whatever the base; with several
// pages and an odd size.
TEST(DeferredMask, FullMaskEqualsNoMask) {
  const GBuffer g = makePatches(53, 41);
  const auto vpls = randomVpls(1100);
  const std::vector<glm::vec3> base(g.pixels.size(), glm::vec3(777));
  for (const int n : {1, 2, 4, 8}) {
    const Mask mask(g, n, [](int, int) { return true; });
    PassTest all("deferred"), masked("deferred");
    const auto expected = run(all, g, vpls, n), image = run(masked, g, vpls, n, &mask, base);
    EXPECT_EQ(image, expected) << "interleave " << n;
    EXPECT_EQ(all.floats("radiance"), masked.floats("radiance"));
    for (const char* name : {"shaded_pixels", "incomplete", "vpls_per_pixel"})
      EXPECT_EQ(masked.counter(name), all.counter(name)) << name;
  }
}

// With few VPLs there are fewer subsets than pixels in a block.
TEST(DeferredMask, FewVplsShadeWholeBlocksToo) {
  const GBuffer g = makePatches(53, 41);
  const std::vector<glm::vec3> base(g.pixels.size(), glm::vec3(777));
  for (const uint32_t count : {1u, 3u, 20u}) {
    const Mask mask(g, 4, [](int, int) { return true; });
    PassTest all("deferred"), masked("deferred");
    EXPECT_EQ(run(all, g, randomVpls(count), 4), run(masked, g, randomVpls(count), 4, &mask, base))
        << count << " VPLs";
  }
}

// Inside a listed patch nothing differs, outside it the base stays, and the cost is that of the patch.
TEST(DeferredMask, PatchEqualsNoMaskAndTheRestIsTheBase) {
  const GBuffer g = makeFloor(64, 48, 0.01f);
  const auto vpls = randomVpls(640);
  const std::vector<glm::vec3> base(g.pixels.size(), glm::vec3(0.25f, 0.5f, 4));
  const Mask mask(g, 4, [](int x, int y) { return x >= 3 && x < 8 && y >= 2 && y < 7; });
  PassTest all("deferred"), masked("deferred");
  const auto expected = run(all, g, vpls, 4), image = run(masked, g, vpls, 4, &mask, base);
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      const size_t i = 4 * size_t(y * g.width + x);
      const bool interior =
          x >= 12 + 2 && x < 32 - 1 && y >= 8 + 2 && y < 28 - 1;  // the window reaches from -2 to +1
      if (interior) {
        for (size_t c = 0; c < 3; ++c) ASSERT_EQ(image[i + c], expected[i + c]) << x << "," << y;
      }
      if (!mask.pixels[i / 4]) {
        for (size_t c = 0; c < 3; ++c) ASSERT_EQ(image[i + c], base[i / 4][int(c)]) << x << "," << y;
      }
    }
  EXPECT_EQ(masked.counter("shaded_pixels"), 25 * 16);
  EXPECT_EQ(masked.counter("vpls_per_pixel"), 40);
}

TEST(DeferredMask, EmptyListTakesTheBaseEverywhere) {
  const GBuffer g = makePatches(40, 30);
  std::vector<glm::vec3> base;
  for (uint32_t i = 0; i < g.pixels.size(); ++i) base.emplace_back(halfRound(random(50, i)));
  const Mask mask(g, 4, [](int, int) { return false; });
  PassTest test("deferred");
  const auto image = run(test, g, randomVpls(200), 4, &mask, base), indirect = test.floats("indirect");
  for (size_t i = 0; i < g.pixels.size(); ++i) {
    const bool surface = g.pixels[i].distance > 0;
    ASSERT_EQ(image[4 * i], surface ? base[i].r : 0);
    ASSERT_NEAR(indirect[4 * i], surface ? 0.5f * base[i].r : 0, 1e-3);
  }
  EXPECT_EQ(test.counter("shaded_pixels"), 0);
}

// Lone blocks, rows and patches of them on a wall with correct light around them: they must not be visible, although
// each of their pixels saw only one VPL of sixteen.
TEST(DeferredMask, ShadedBlocksHaveNoSeams) {
  const GBuffer g = makeFloor(96, 96, 0.005f);
  const auto vpls = randomVpls(320);
  PassTest all("deferred"), masked("deferred"), plain("deferred");
  const auto truth = colors(run(all, g, vpls, 1)), filtered = colors(run(plain, g, vpls, 4));
  const Mask mask(g, 4, [](int x, int y) {
    return random(60, uint32_t(x + 32 * y)) < 0.2f || y == 12 || (x > 17 && y > 19);
  });
  const auto image = colors(run(masked, g, vpls, 4, &mask, filtered));
  double worst = 0, worstPlain = 0;
  for (size_t i = 0; i < image.size(); ++i) {
    worst = std::max(worst, double(glm::length(image[i] - truth[i]) / glm::length(truth[i])));
    worstPlain = std::max(worstPlain, double(glm::length(filtered[i] - truth[i]) / glm::length(truth[i])));
  }
  EXPECT_LT(worst, 0.01);                    // the light changes by that much over a block
  EXPECT_LT(worst, 3 * worstPlain + 0.002);  // and the filter without a mask is not much better
}

// Compares everything at once with the CPU: patches, maps of random blocks, and a base of noise.
TEST(DeferredMask, RandomMasksEqualTheReference) {
  const GBuffer g = makePatches(50, 38);
  const auto vpls = randomVpls(300);
  std::vector<glm::vec3> base;
  for (uint32_t i = 0; i < g.pixels.size(); ++i)
    base.emplace_back(halfRound(glm::vec3(random(70, i), random(71, i), random(72, i))));
  for (const int n : {1, 2, 4, 8}) {
    const Mask mask(g, n, [n](int x, int y) { return random(73, uint32_t(n * 4096 + x + 64 * y)) < 0.4f; });
    DeferredReference reference;
    reference.interleave = n;
    reference.mask = &mask.pixels;
    reference.base = &base;
    PassTest test("deferred");
    const auto image = colors(run(test, g, vpls, n, &mask, base));
    const auto expected = reference.irradiance(g, vpls);
    size_t wrong = 0, shaded = 0;
    for (size_t i = 0; i < image.size(); ++i) {
      const double error = glm::length(glm::dvec3(image[i]) - expected[i]);
      wrong += !(error <= 5e-3 * glm::length(expected[i]) + 1e-5);
      shaded += g.pixels[i].distance > 0 && mask.pixels[i];
    }
    EXPECT_LE(wrong, image.size() / 200) << "interleave " << n;  // on the brink of belonging to a surface
    EXPECT_EQ(test.counter("shaded_pixels"), double(shaded));
  }
}

TEST(DeferredMask, WrongWiringIsRefused) {
  const GBuffer g = makeFloor(16, 16, 0.1f);
  const auto expectRefused = [&](const std::function<void(PassTest&)>& wire, const std::string& why) {
    PassTest test("deferred");
    g.wire(test);
    test.buffer("vpls", randomVpls(100), "Vpl").param("interleave", 4);
    wire(test);
    try {
      test.run();
      ADD_FAILURE() << "accepted: " << why;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::BadInput);
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  const std::vector<glm::vec3> base(g.pixels.size());
  const auto everything = [](int, int) { return true; };
  expectRefused([&](PassTest& t) { Mask(g, 4, everything).wire(t, g); }, "nothing is wired to `base`");
  expectRefused([&](PassTest& t) { Mask(g, 2, everything).wire(t, g), wireBase(t, g, base); },
                "blocks of another size than `interleave` (shade.blocks.count is 64, ");
}

}  // namespace
}  // namespace fovea::test
