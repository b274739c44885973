// Tests the measure of the difference between the eyes on hand-made pictures whose differences are known.
#include "framework/image/eyes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/error.h"
#include "framework/base/random.h"

namespace fovea::image {
namespace {

using testing::HasSubstr;

constexpr Disc kEverything{0, 0, 1e6f};
constexpr uint32_t kWidth = 8, kHeight = 4;
constexpr size_t kPixels = size_t(kWidth) * kHeight;

Image flat(float value) { return {kWidth, kHeight, 3, std::vector<float>(kPixels * 3, value)}; }

// The light at a place in pixels, the same in all channels.
template <class Light>
Image lightOf(Light light) {
  Image image = flat(0);
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      for (uint32_t c = 0; c < 3; ++c) image.at(x, y, c) = light(float(x) + 0.5f, float(y) + 0.5f);
  return image;
}

// Every pixel's surface is so many pixels to the left in the right eye, and all pixels around that show it. What lies
// outside is not seen.
Image shifted(float disparity) {
  Image c = flat(0);
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      const float at = float(x) + 0.5f - disparity;
      if (at < 0.5f || at > float(kWidth) - 0.5f) continue;
      c.at(x, y, 0) = at, c.at(x, y, 1) = float(y) + 0.5f;
      c.at(x, y, 2) = at == float(kWidth) - 0.5f ? 1 : 3;  // one pixel or two side by side
    }
  return c;
}

struct Pair {
  Image left, right;
};
struct PairHalves {
  Pair a, b;
};

// Adds a frame at exposure 1.
void add(EyesComparison& comparison, const Pair& image, const Pair& reference, const Image& correspondence,
         const Disc& fovea = kEverything, const std::optional<PairHalves>& halves = {}) {
  const auto lit = [](const Image& radiance) { return fromRadiance(radiance, 1); };
  const Picture left = lit(image.left), right = lit(image.right), exactLeft = lit(reference.left),
                exactRight = lit(reference.right);
  std::optional<Halves> l, r;
  if (halves)
    l = {lit(halves->a.left), lit(halves->b.left)}, r = {lit(halves->a.right), lit(halves->b.right)};
  comparison.add({&left, &exactLeft, l ? &*l : nullptr}, {&right, &exactRight, r ? &*r : nullptr},
                 correspondence, 1, fovea);
}

PerRegion<EyeMeasures> compareOnce(const Pair& image, const Pair& reference, const Image& correspondence,
                                   const Disc& fovea = kEverything) {
  EyesComparison comparison;
  add(comparison, image, reference, correspondence, fovea);
  return comparison.result();
}

double step(float a, float b) { return double(srgbEncode(a)) - srgbEncode(b); }

TEST(Eyes, EqualEyesDoNotDiffer) {
  Image noise = flat(0);
  for (size_t i = 0; i < noise.data.size(); ++i) noise.data[i] = uniformFloat(uint32_t(i) * 747796405u);
  const auto m = compareOnce({noise, noise}, {flat(0.3f), flat(0.3f)}, shifted(0), {4, 2, 2});
  for (const EyeMeasures& region : {m.fovea, m.periphery, m.whole}) {
    EXPECT_EQ(region.share, 1);
    EXPECT_EQ(region.difference, 0);
    EXPECT_EQ(region.referenceDifference, 0);
    EXPECT_EQ(region.excess, 0);
    EXPECT_TRUE(std::isnan(region.noiseFloor));
    EXPECT_TRUE(std::isnan(region.flicker)) << "of a single frame";
  }
  EXPECT_EQ(m.whole.pixels, kPixels);
  EXPECT_EQ(m.fovea.pixels + m.periphery.pixels, kPixels);
}

// The right eye is brighter, in one channel and only where the left eye's fovea looks.
TEST(Eyes, ATintOfOneEyeHasItsSquare) {
  const Disc fovea{1, 1, 0.75f};  // the centres of four pixels
  Image tinted = flat(0.25f);
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      if (fovea.contains(x, y)) tinted.at(x, y, 1) = 0.5f;
  const auto m = compareOnce({flat(0.25f), tinted}, {flat(0.1f), flat(0.1f)}, shifted(0), fovea);
  const double square = std::pow(step(0.25f, 0.5f), 2) / 3;
  EXPECT_EQ(m.fovea.pixels, 4u);
  EXPECT_NEAR(m.fovea.difference, square, 1e-8);
  EXPECT_NEAR(m.fovea.excess, square, 1e-8);
  EXPECT_EQ(m.fovea.referenceDifference, 0);
  EXPECT_EQ(m.periphery.excess, 0);
  EXPECT_NEAR(m.whole.excess, square * 4 / kPixels, 1e-8);
}

// Both eyes see the same ramp of light, the right one 1.5 pixels farther to the left.
TEST(Eyes, ParallaxIsNoDifference) {
  const Pair ramps{lightOf([](float x, float y) { return 0.05f * x + 0.02f * y; }),
                   lightOf([](float x, float y) { return 0.05f * (x + 1.5f) + 0.02f * y; })};
  const auto m = compareOnce(ramps, {flat(0), flat(0)}, shifted(1.5f));
  EXPECT_EQ(m.whole.pixels, 6 * kHeight) << "two columns are outside the right picture";
  EXPECT_DOUBLE_EQ(m.whole.share, 6.0 / 8);
  EXPECT_LT(m.whole.difference, 1e-12);
  EXPECT_GT(compareOnce(ramps, {flat(0), flat(0)}, shifted(0)).whole.difference, 1e-4);
}

TEST(Eyes, WhatTheOtherEyeDoesNotSeeDoesNotCount) {
  Image bright = flat(0.2f), places = shifted(0);
  bright.at(2, 1, 0) = bright.at(3, 1, 0) = 50;
  places.at(2, 1, 2) = 0;
  // Of the pixels around this place only the right one shows the surface, so that the bright one does not count.
  places.at(4, 1, 0) = 4.25f, places.at(4, 1, 2) = 2;
  places.at(3, 1, 2) = 0;
  const auto m = compareOnce({bright, bright}, {flat(0.2f), flat(0.2f)}, places);
  EXPECT_EQ(m.whole.pixels, kPixels - 2);
  EXPECT_EQ(m.whole.difference, 0);
  EXPECT_TRUE(std::isnan(compareOnce({bright, bright}, {bright, bright}, flat(0)).whole.excess));
  EXPECT_EQ(compareOnce({bright, bright}, {bright, bright}, flat(0)).whole.share, 0);
}

// Radiance is averaged before it is displayed, with the bilinear weights of the pixels that show the surface.
TEST(Eyes, RadianceIsBilinearAmongThePixelsOfTheSurface) {
  Image right = flat(0), places = flat(0);
  const float lights[] = {0.1f, 0.2f, 0.4f, 0.8f};
  for (uint32_t i = 0; i < 4; ++i)
    for (uint32_t c = 0; c < 3; ++c) right.at(2 + i % 2, 1 + i / 2, c) = lights[i];
  places.at(5, 0, 0) = 2.75f, places.at(5, 0, 1) = 2.25f;  // a quarter to the right, three quarters down
  const double weights[] = {3.0 / 16, 1.0 / 16, 9.0 / 16, 3.0 / 16};
  for (uint32_t shown = 1; shown < 16; ++shown) {
    places.at(5, 0, 2) = float(shown);
    double sum = 0, weight = 0;
    for (uint32_t i = 0; i < 4; ++i)
      if (shown >> i & 1) sum += weights[i] * lights[i], weight += weights[i];
    const auto m = compareOnce({flat(0), right}, {flat(0), flat(0)}, places);
    EXPECT_EQ(m.whole.pixels, 1u);
    EXPECT_NEAR(m.whole.difference, std::pow(srgbEncode(float(sum / weight)), 2), 1e-6) << shown;
  }
}

TEST(Eyes, DifferencesOfTheReferenceAreNoExcess) {
  const auto m = compareOnce({flat(0.5f), flat(0.25f)}, {flat(0.5f), flat(0.25f)}, shifted(0));
  EXPECT_EQ(m.whole.excess, 0);
  EXPECT_NEAR(m.whole.difference, std::pow(step(0.5f, 0.25f), 2), 1e-8);
  EXPECT_EQ(m.whole.referenceDifference, m.whole.difference);
  // A picture whose eyes agree although they should not.
  EXPECT_NEAR(compareOnce({flat(0.5f), flat(0.5f)}, {flat(0.5f), flat(0.25f)}, shifted(0)).whole.excess,
              std::pow(step(0.5f, 0.25f), 2), 1e-8);
}

// The eyes of a half have noise of their own, and noise in common, which is in no difference.
TEST(Eyes, NoiseOfTheReferenceIsSubtracted) {
  constexpr float kTruth = 0.3f, kTint = 0.305f, kNoise = 0.02f;
  EyesComparison comparison, exact;
  const auto noise = [](uint32_t stream, size_t i) {
    return kNoise * (2 * uniformFloat(hashCombine(stream, uint32_t(i))) - 1);
  };
  for (uint32_t frame = 0; frame < 400; ++frame) {
    PairHalves halves{{flat(kTruth), flat(kTruth)}, {flat(kTruth), flat(kTruth)}};
    Pair mean{flat(0), flat(0)};
    uint32_t stream = 10 * frame;
    for (Pair* half : {&halves.a, &halves.b}) {
      for (size_t i = 0; i < half->left.data.size(); ++i) {
        half->left.data[i] += noise(stream, i) + noise(stream + 2, i);
        half->right.data[i] += noise(stream + 1, i) + noise(stream + 2, i);
        mean.left.data[i] += half->left.data[i] / 2;
        mean.right.data[i] += half->right.data[i] / 2;
      }
      stream += 3;
    }
    add(comparison, {flat(kTruth), flat(kTint)}, mean, shifted(0), kEverything, halves);
    add(exact, {flat(kTruth), flat(kTint)}, {flat(kTruth), flat(kTruth)}, shifted(0));
  }
  const EyeMeasures m = comparison.result().whole, wanted = exact.result().whole;
  EXPECT_EQ(m.pixels, 400 * kPixels);
  EXPECT_GT(m.noiseFloor, 2 * wanted.excess) << "the noise must matter";
  EXPECT_NEAR(m.excess, wanted.excess, 0.03 * m.noiseFloor);
  EXPECT_NEAR(m.referenceDifference, 0, 0.03 * m.noiseFloor);
  // The frames of the reference are independent, so the noise of a change is twice that of a frame.
  EXPECT_NEAR(m.flickerNoiseFloor, 2 * m.noiseFloor, 0.05 * m.noiseFloor);
  EXPECT_NEAR(m.flicker, 0, 0.05 * m.noiseFloor);
}

// ---- Over time --------------------------------------------------------------------------------------------

TEST(Eyes, FlickerIsTheChangeOfTheDifference) {
  EyesComparison comparison;
  const float right[] = {0.2f, 0.3f, 0.3f}, exact[] = {0.2f, 0.2f, 0.1f};
  for (int i = 0; i < 3; ++i)
    add(comparison, {flat(0.2f), flat(right[i])}, {flat(0.2f), flat(exact[i])}, shifted(0));
  const EyeMeasures m = comparison.result().whole;
  // d of the sequence goes from 0 to -a and stays; that of the reference stays 0 and then goes to b.
  const double a = step(0.3f, 0.2f), b = step(0.2f, 0.1f);
  EXPECT_NEAR(m.difference, 2 * a * a / 3, 1e-7);
  EXPECT_NEAR(m.referenceDifference, b * b / 3, 1e-7);
  EXPECT_NEAR(m.excess, (a * a + (a + b) * (a + b)) / 3, 1e-7);
  EXPECT_NEAR(m.flicker, (a * a + b * b) / 2, 1e-7);
  EXPECT_EQ(m.pixels, 3 * kPixels);
}

// A constant difference does not flicker, and neither do pixels that are compared in one of two frames only.
TEST(Eyes, FlickerNeedsBothFrames) {
  EyesComparison comparison;
  Image places = shifted(0), tinted = flat(0.4f);
  add(comparison, {flat(0.2f), tinted}, {flat(0.2f), flat(0.2f)}, places);
  places.at(3, 2, 2) = 0;
  tinted.at(3, 2, 0) = 9;
  add(comparison, {flat(0.2f), tinted}, {flat(0.2f), flat(0.2f)}, places);
  EXPECT_EQ(comparison.result().whole.flicker, 0);
  EXPECT_GT(comparison.result().whole.excess, 0.01);
  EXPECT_EQ(comparison.result().whole.pixels, 2 * kPixels - 1);
  add(comparison, {flat(0.2f), tinted}, {flat(0.2f), flat(0.2f)}, shifted(0));
  EXPECT_EQ(comparison.result().whole.flicker, 0) << "the pixel was not seen in the frame before";
}

TEST(Eyes, PictureOfTheExcess) {
  EyesComparison comparison;
  Image places = shifted(0), tinted = flat(0.25f);
  tinted.at(1, 0, 2) = tinted.at(2, 0, 2) = 0.5f;
  places.at(2, 0, 2) = 0;
  add(comparison, {flat(0.25f), tinted}, {flat(0.1f), flat(0.1f)}, places);
  std::vector<float> wanted(kPixels, 0);
  wanted[1] = float(-step(0.25f, 0.5f) / std::sqrt(3.0));
  EXPECT_THAT(comparison.pixelExcess(), testing::Pointwise(testing::FloatNear(1e-6f), wanted));
}

// ---- Mistakes ---------------------------------------------------------------------------------------------

template <class F>
void expectRefused(const std::vector<std::string>& words, F&& f) {
  try {
    f();
    FAIL() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    for (const std::string& word : words) EXPECT_THAT(std::string(e.what()), HasSubstr(word));
  }
}

TEST(Eyes, WhatCannotBeComparedIsRefused) {
  const Pair good{flat(1), flat(1)};
  const Image small{1, 1, 3, {1, 1, 1}};
  Image bad = flat(1);
  bad.at(5, 2, 1) = std::nanf("");
  const auto run = [&](const Pair& image, const Pair& reference, const Image& places) {
    compareOnce(image, reference, places);
  };
  expectRefused({"picture of the left eye", "1x1", "8x4"}, [&] { run({small, flat(1)}, good, shifted(0)); });
  expectRefused({"picture of the right eye", "1x1"}, [&] { run({flat(1), small}, good, shifted(0)); });
  expectRefused({"reference of the right eye", "1x1"}, [&] { run(good, {flat(1), small}, shifted(0)); });
  expectRefused({"correspondence", "1x1"}, [&] { run(good, good, small); });
  expectRefused({"picture of the right eye", "NaN", "5, 2"}, [&] { run({flat(1), bad}, good, shifted(0)); });
  expectRefused({"reference of the left eye", "NaN"}, [&] { run(good, {bad, flat(1)}, shifted(0)); });
  expectRefused({"correspondence", "NaN"}, [&] { run(good, good, bad); });
  const Picture display = fromDisplay(flat(0.5f)), lit = fromRadiance(flat(0.5f), 1);
  expectRefused({"right eye", "no radiance", ".exr"}, [&] {
    EyesComparison().add({&lit, &lit}, {&display, &lit}, shifted(0), 1, kEverything);
  });
}

TEST(Eyes, PlacesOutsideThePictureAreRefused) {
  const Pair good{flat(1), flat(1)};
  const auto refused = [&](float x, float y, float shown) {
    Image places = shifted(0);
    places.at(3, 1, 0) = x, places.at(3, 1, 1) = y, places.at(3, 1, 2) = shown;
    expectRefused({"pixel 3, 1", "names no pixels", "`correspondence`"},
                  [&] { compareOnce(good, good, places); });
  };
  refused(3.5f, 1.5f, 16);
  refused(3.5f, 1.5f, 1.5f);
  refused(3.5f, 1.5f, -1);
  refused(-1, 1.5f, 2);
  refused(3.5f, 5, 1);
  refused(1e30f, 1.5f, 1);
  refused(7.75f, 1.5f, 3);  // the pixel to the right of the last one
  refused(3.5f, 0.25f, 1);  // the pixel above the first one
}

TEST(Eyes, FramesAreAlike) {
  const Pair good{flat(1), flat(1)};
  EyesComparison comparison;
  add(comparison, good, good, shifted(0));
  expectRefused({"only some frames", "halves"}, [&] {
    add(comparison, good, good, shifted(0), kEverything, PairHalves{good, good});
  });
  const Image small{1, 1, 3, {1, 1, 1}}, place{1, 1, 3, {0.5f, 0.5f, 1}};
  expectRefused({"frames differ in size", "--size"}, [&] {
    add(comparison, {small, small}, {small, small}, place);
  });
  EXPECT_EQ(comparison.frames(), 1u);
}

}  // namespace
}  // namespace fovea::image
