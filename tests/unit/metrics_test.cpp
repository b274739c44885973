// Tests error measures on hand-made pictures whose errors are known.
#include "framework/image/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/error.h"
#include "framework/base/random.h"
#include "framework/image/flip.h"

namespace fovea::image {
namespace {

using testing::HasSubstr;

constexpr Disc kEverything{0, 0, 1e6f}, kNothing{-100, -100, 1};

Image flat(uint32_t width, uint32_t height, float value) {
  return {width, height, 3, std::vector<float>(size_t(width) * height * 3, value)};
}

float uniform(uint32_t seed, size_t i) { return uniformFloat(hashCombine(seed, uint32_t(i))); }

// Noise of mean 0 and variance 1/3.
float symmetric(uint32_t seed, size_t i) { return 2 * uniform(seed, i) - 1; }

Picture display(Image image) { return fromDisplay(image); }

template <class F>
void expectError(const std::vector<std::string>& words, F&& f) {
  try {
    f();
    FAIL() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    for (const std::string& word : words) EXPECT_THAT(std::string(e.what()), HasSubstr(word));
  }
}

TEST(Metrics, DisplayIsTheScreensTransferOfTheExposedRadiance) {
  const Image t = displayed({3, 1, 3, {0, 0.09f, 0.5f, 1, -1, 100, 0.001f, 0.002f, 0.05f}}, 2);
  const float expected[] = {0, 0.46135613f, 1, 1, 0, 1, 0.02584f, 0.05070871f, 0.3491902f};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(t.data[i], expected[i], 1e-6) << i;
}

TEST(Metrics, PicturesOfOneOrFourChannelsAreRgb) {
  EXPECT_THAT(toRgb({2, 1, 1, {0.5f, 1}}).data, testing::ElementsAre(0.5f, 0.5f, 0.5f, 1, 1, 1));
  EXPECT_THAT(toRgb({1, 1, 4, {1, 2, 3, 9}}).data, testing::ElementsAre(1, 2, 3));
}

// The centres of four of the 16 pixels are within 0.75 of (1, 1).
TEST(Metrics, RegionsArePixelsWhoseCentreLiesInTheDisc) {
  const Disc disc{1, 1, 0.75f};
  Image a = flat(4, 4, 0.5f), b = a;
  b.at(0, 0, 0) += 0.3f;  // in the disc
  b.at(3, 2, 1) -= 0.2f;  // outside
  const auto m = compare(display(b), display(a), {}, disc, kDefaultPixelsPerDegree);
  EXPECT_EQ(m.fovea.pixels, 4u);
  EXPECT_EQ(m.periphery.pixels, 12u);
  EXPECT_EQ(m.whole.pixels, 16u);
  EXPECT_NEAR(m.fovea.mse, 0.09 / 12, 1e-8);
  EXPECT_NEAR(m.periphery.mse, 0.04 / 36, 1e-8);
  EXPECT_NEAR(m.whole.mse, 0.13 / 48, 1e-8);
  EXPECT_NEAR(m.whole.psnr, 10 * std::log10(48 / 0.13), 1e-5);
  EXPECT_TRUE(std::isnan(m.whole.relMse)) << "of a display-referred picture";
  EXPECT_TRUE(std::isnan(m.whole.noiseFloor));
  EXPECT_NEAR(m.whole.flip, (4 * m.fovea.flip + 12 * m.periphery.flip) / 16, 1e-9);
  EXPECT_GT(m.fovea.flip, 0);
  const auto mse = meanSquaredError(display(b), display(a), disc);
  EXPECT_EQ(mse.fovea, m.fovea.mse);
  EXPECT_EQ(mse.whole, m.whole.mse);
}

TEST(Metrics, RadianceIsComparedAsDisplayedAndRelatively) {
  const Picture g = fromRadiance({1, 1, 3, {0, 0.04f, 0.5f}}, 1),
                a = fromRadiance({1, 1, 3, {0, 0.14f, 8}}, 1);
  const auto m = compare(a, g, {}, kEverything, kDefaultPixelsPerDegree);
  const double t = 1.055 * (std::pow(0.14, 1 / 2.4) - std::pow(0.04, 1 / 2.4)),
               w = 1 - (1.055 * std::pow(0.5, 1 / 2.4) - 0.055);
  EXPECT_NEAR(m.fovea.mse, (t * t + w * w) / 3, 1e-6);
  EXPECT_NEAR(m.fovea.relMse, (4 + std::pow(7.5 / 0.51, 2)) / 3, 1e-3);
  EXPECT_EQ(m.periphery.pixels, 0u);
  for (const double v : {m.periphery.mse, m.periphery.psnr, m.periphery.relMse, m.periphery.flip})
    EXPECT_TRUE(std::isnan(v));
}

TEST(Metrics, EqualPicturesHaveNoError) {
  Image noise = flat(20, 10, 0);
  for (size_t i = 0; i < noise.data.size(); ++i) noise.data[i] = uniform(1, i);
  const auto m = compare(fromRadiance(noise, 1), fromRadiance(noise, 1), {}, {10, 5, 4}, 67);
  EXPECT_EQ(m.fovea.mse, 0);
  EXPECT_EQ(m.whole.relMse, 0);
  EXPECT_EQ(m.periphery.flip, 0);
  EXPECT_EQ(m.whole.psnr, std::numeric_limits<double>::infinity());
}

// In noise, neighbouring pixels differ as much across the lines of a lattice as beside them. If blocks of 8 or 16 pixels
// are added, the measure finds them where they are; it does not find blocks of 7 pixels.
TEST(Metrics, BlocksShowAgainstTheReference) {
  constexpr uint32_t kSize = 192;
  constexpr Disc kLeft{0, kSize / 2, kSize / 2};
  Image noise = flat(kSize, kSize, 0.3f), other = noise;
  for (size_t i = 0; i < noise.data.size(); ++i) {
    noise.data[i] += 0.02f * symmetric(3, i);
    other.data[i] += 0.01f * symmetric(4, i);
  }
  EXPECT_NEAR(blockiness(display(noise), display(other), kLeft).whole, 1, 0.05);
  for (const uint32_t side : {8u, 16u, 7u}) {
    Image blocks = noise;
    for (uint32_t y = 0; y < kSize; ++y)
      for (uint32_t x = 0; x < kSize; ++x)
        for (uint32_t c = 0; c < 3 && !kLeft.contains(x, y); ++c)
          blocks.at(x, y, c) += (x / side + y / side) % 2 == 0 ? 0.01f : -0.01f;
    const auto got = blockiness(display(blocks), display(other), kLeft);
    // Squared differences have the mean 2 * 0.02^2 / 3 in the noise, to which the edges of blocks add 0.02^2.
    EXPECT_NEAR(got.periphery, side == 7 ? 1 : 2.5, side == 7 ? 0.15 : 0.2) << side;
    EXPECT_NEAR(got.fovea, 1, 0.15) << side;
    const auto m = compare(display(blocks), display(other), {}, kLeft, kDefaultPixelsPerDegree);
    EXPECT_EQ(m.periphery.blocks, got.periphery);
  }
  EXPECT_TRUE(std::isnan(blockiness(display(flat(4, 4, 1)), display(flat(4, 4, 1)), kLeft).whole));
}

// The reference is the mean of two noisy halves; with its noise subtracted, the errors are those against the truth.
TEST(Metrics, NoiseOfTheReferenceIsSubtracted) {
  constexpr uint32_t kSide = 200;
  constexpr float kTruth = 0.3f, kError = 0.004f, kNoise = 0.03f;
  Image a = flat(kSide, kSide, kTruth), b = a, g = a;
  for (size_t i = 0; i < g.data.size(); ++i) {
    a.data[i] += kNoise * symmetric(1, i);
    b.data[i] += kNoise * symmetric(2, i);
    g.data[i] = 0.5f * (a.data[i] + b.data[i]);
  }
  const Picture image = fromRadiance(flat(kSide, kSide, kTruth + kError), 1),
                truth = fromRadiance(flat(kSide, kSide, kTruth), 1);
  const std::optional<Halves> halves(Halves{fromRadiance(a, 1), fromRadiance(b, 1)});
  const Disc disc{100, 100, 60};
  const auto exact = compare(image, truth, {}, disc, 67);
  const auto m = compare(image, fromRadiance(g, 1), halves, disc, 67);
  EXPECT_GT(m.whole.noiseFloor, 3 * exact.whole.mse) << "the noise must matter";
  // The noise floor of 120,000 squares has a relative spread of about 1/sqrt(n).
  EXPECT_NEAR(m.whole.mse, exact.whole.mse, 0.02 * m.whole.noiseFloor);
  EXPECT_NEAR(m.fovea.mse, exact.fovea.mse, 0.04 * m.fovea.noiseFloor);
  // The noise is also in the denominator, which leaves 4 (error / truth) of it: 5%.
  EXPECT_NEAR(m.whole.relMse, exact.whole.relMse, 0.07 * m.whole.relMseNoiseFloor);
  EXPECT_NEAR(m.whole.relMseNoiseFloor, kNoise * kNoise / 6 / std::pow(kTruth + 0.01, 2),
              0.03 * m.whole.relMseNoiseFloor);
}

TEST(Metrics, WhatCannotBeComparedIsRefused) {
  const Picture good = fromRadiance(flat(2, 1, 1), 1);
  const auto run = [&](const Picture& a, const Picture& b, std::optional<Halves> halves = {}) {
    return compare(a, b, halves, kEverything, 67);
  };
  expectError({"2x1", "1x2"}, [&] { run(good, fromRadiance(flat(1, 2, 1), 1)); });
  expectError({"empty"}, [&] { run({}, {}); });
  for (const float value : {std::nanf(""), INFINITY, -INFINITY}) {
    Image bad = flat(2, 1, 1);
    bad.at(1, 0, 2) = value;
    const Picture picture = fromRadiance(bad, 1);
    expectError({"picture", "NaN", "1, 0"}, [&] { run(picture, good); });
    expectError({"reference", "NaN"}, [&] { run(good, picture); });
    expectError({"half"}, [&] { run(good, good, Halves{good, picture}); });
    expectError({"NaN"}, [&] { run(fromDisplay(bad), good); });
    expectError({"NaN"}, [&] { meanSquaredError(picture, picture, kEverything); });
  }
  expectError({"half", "3x1"}, [&] { run(good, good, Halves{fromRadiance(flat(3, 1, 1), 1), good}); });
}

// ---- Sequences --------------------------------------------------------------------------------------------

TEST(SequenceMeasures, ChangesAgainstHandMadeOnes) {
  // Over the whole picture, the truth rises by 0.1 per frame, the sequence by 0.1 and then by 0.4.
  SequenceComparison sequence;
  const float truth[] = {0.1f, 0.2f, 0.3f}, image[] = {0.15f, 0.25f, 0.65f};
  for (int i = 0; i < 3; ++i)
    sequence.add(display(flat(4, 2, image[i])), display(flat(4, 2, truth[i])), {}, {1, 1, 1});
  const auto m = sequence.result();
  EXPECT_EQ(m.whole.pairs, 2u);
  EXPECT_NEAR(m.whole.mse, (0.0025 + 0.0025 + 0.1225) / 3, 1e-6);
  EXPECT_NEAR(m.whole.change, (0.01 + 0.16) / 2, 1e-6);
  EXPECT_NEAR(m.whole.referenceChange, 0.01, 1e-6);
  EXPECT_NEAR(m.whole.excess, 0.09 / 2, 1e-6);
  EXPECT_NEAR(m.fovea.excess, m.whole.excess, 1e-9);
  EXPECT_TRUE(std::isnan(m.whole.excessNoiseFloor));
}

// Each pair counts in the fovea of its later frame; frames whose fovea is outside the picture count in the periphery.
TEST(SequenceMeasures, TheFoveaMoves) {
  SequenceComparison sequence;
  Image spot = flat(8, 1, 0);
  spot.at(6, 0, 0) = 1;
  sequence.add(display(flat(8, 1, 0)), display(flat(8, 1, 0)), {}, {1, 0.5f, 1});
  sequence.add(display(spot), display(flat(8, 1, 0)), {}, {6.5f, 0.5f, 0.1f});
  sequence.add(display(spot), display(flat(8, 1, 0)), {}, kNothing);
  const auto m = sequence.result();
  EXPECT_EQ(m.fovea.pairs, 1u);
  EXPECT_NEAR(m.fovea.change, 1.0 / 3, 1e-9);
  EXPECT_NEAR(m.fovea.mse, (0 + 1.0 / 3) / 2, 1e-9);
  EXPECT_NEAR(m.periphery.mse, (0 + 0 + 1.0 / 24) / 3, 1e-9);
}

// A picture that follows the truth exactly has no excess; noise of the reference, which is new in every frame, must
// not appear as excess.
TEST(SequenceMeasures, NoiseOfTheReferenceIsSubtracted) {
  constexpr uint32_t kSide = 150;
  constexpr float kNoise = 0.03f;
  SequenceComparison sequence;
  for (uint32_t frame = 0; frame < 3; ++frame) {
    const Image truth = flat(kSide, kSide, 0.4f + 0.01f * float(frame));
    Image a = truth, b = truth, g = truth;
    for (size_t i = 0; i < g.data.size(); ++i) {
      a.data[i] += kNoise * symmetric(10 + frame, i);
      b.data[i] += kNoise * symmetric(20 + frame, i);
      g.data[i] = 0.5f * (a.data[i] + b.data[i]);
    }
    sequence.add(display(truth), display(g), Halves{display(a), display(b)}, {75, 75, 50});
  }
  const auto m = sequence.result();
  const double noise = kNoise * kNoise / 6;  // of one frame of the reference
  EXPECT_NEAR(m.whole.noiseFloor, noise, 0.02 * noise);
  EXPECT_NEAR(m.whole.excessNoiseFloor, 2 * noise, 0.04 * noise);
  EXPECT_NEAR(m.whole.mse, 0, 0.02 * noise);
  EXPECT_NEAR(m.whole.excess, 0, 0.04 * noise);
  EXPECT_NEAR(m.whole.change, 1e-4, 1e-7);
  EXPECT_NEAR(m.whole.referenceChange, 1e-4, 0.05 * noise);
}

TEST(SequenceMeasures, WhatCannotBeComparedIsRefused) {
  SequenceComparison sequence;
  expectError({"two frames"}, [&] { sequence.result(); });
  const Picture good = display(flat(2, 2, 0.5f)), other = display(flat(3, 2, 0.5f));
  sequence.add(good, good, Halves{good, good}, kEverything);
  expectError({"two frames"}, [&] { sequence.result(); });
  expectError({"halves"}, [&] { sequence.add(good, good, {}, kEverything); });
  expectError({"3x2"}, [&] { sequence.add(other, other, Halves{other, other}, kEverything); });
  expectError({"3x2"}, [&] { sequence.add(good, other, {}, kEverything); });
}

}  // namespace
}  // namespace fovea::image
