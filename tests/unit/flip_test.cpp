// Compares LDR-FLIP with values of its authors' tool and with properties that follow from its definition.
#include "framework/image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "fovea/error.h"

namespace fovea::image {
namespace {

constexpr uint32_t kWidth = 64, kHeight = 48;

template <class Value>
Image picture(Value value) {
  Image image{kWidth, kHeight, 3, {}};
  for (int y = 0; y < int(kHeight); ++y)
    for (int x = 0; x < int(kWidth); ++x)
      for (int c = 0; c < 3; ++c) image.data.push_back(float(value(x, y, c)) / 255.0f);
  return image;
}

Image chirp(int dx, int dy) {
  return picture([=](int x, int y, int c) {
    const int u = x + dx, v = y + dy;
    return (u * u + 3 * v * v + 5 * u * v + 17 * c * u + 31 * c * v) % 256;
  });
}

Image smooth(int checker) {
  return picture([=](int x, int y, int c) {
    const int ramp[] = {3 * x + 20, 5 * y, 2 * (x + y)};
    return ramp[c] + checker * ((x / 4 + y / 4) % 2);
  });
}

Image squares(bool coloured) {
  static constexpr int kLight[] = {200, 230, 255}, kDark[] = {40, 20, 90};
  return picture([=](int x, int y, int c) {
    const bool light = (x / 8 + y / 8) % 2 == 1;
    return coloured ? (light ? kLight[c] : kDark[c]) : light ? 255 : 0;
  });
}

Image grey(double value) {
  return picture([=](int, int, int) { return 255 * value; });
}

double mean(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / double(map.size());
}

double flipOf(const Image& a, const Image& b, double pixelsPerDegree = kDefaultPixelsPerDegree) {
  return mean(flip(a, b, pixelsPerDegree));
}

// Results of version 1.7 of the authors' package flip-evaluator, evaluate(reference, test, "LDR"), on the same
// pictures: the mean, and the pixels (0, 0), (17, 9), (31, 24) and (63, 47).
TEST(Flip, MatchesTheAuthorsTool) {
  struct Case {
    const char* name;
    Image reference, test;
    double pixelsPerDegree, mean, pixels[4];
  };
  const Case cases[] = {
      {"chirp", chirp(0, 0), chirp(2, 1), 67, 0.332814, {0.819886, 0.359630, 0.241130, 0.673995}},
      {"chirp", chirp(0, 0), chirp(2, 1), 20, 0.840009, {0.917981, 0.962838, 0.982593, 0.959967}},
      {"smooth", smooth(0), smooth(12), 67, 0.142463, {0.006159, 0.059663, 0.141232, 0.013567}},
      {"smooth", smooth(0), smooth(12), 20, 0.139138, {0.000000, 0.000957, 0.218705, 0.000000}},
      {"squares", squares(false), squares(true), 67, 0.579921, {0.515919, 0.591368, 0.506740, 0.515919}},
      {"squares", squares(false), squares(true), 20, 0.590692, {0.475175, 0.625478, 0.586270, 0.475175}},
      {"black, white", grey(0), grey(1), 67, 0.967365, {0.967392, 0.967392, 0.967392, 0.967392}}};
  constexpr size_t kPlaces[] = {0, 9 * kWidth + 17, 24 * kWidth + 31, 47 * kWidth + 63};
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.name) + " at " + std::to_string(c.pixelsPerDegree));
    const std::vector<float> map = flip(c.reference, c.test, c.pixelsPerDegree);
    EXPECT_NEAR(mean(map), c.mean, 1e-4);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(map[kPlaces[i]], c.pixels[i], 3e-4) << i;
  }
}

TEST(Flip, IsSymmetricAndBetweenZeroAndOne) {
  const std::vector<float> ab = flip(chirp(0, 0), smooth(12)), ba = flip(smooth(12), chirp(0, 0));
  for (size_t i = 0; i < ab.size(); ++i) {
    ASSERT_NEAR(ab[i], ba[i], 1e-6);
    ASSERT_TRUE(ab[i] >= 0 && ab[i] <= 1);
  }
  for (const float value : flip(chirp(0, 0), chirp(0, 0))) ASSERT_EQ(value, 0);
  // The greatest possible difference in colour.
  const auto pure = [](int channel) {
    return picture([=](int, int, int c) { return c == channel ? 255 : 0; });
  };
  EXPECT_NEAR(flipOf(pure(1), pure(2)), 1, 1e-3);
}

TEST(Flip, GrowsWithTheDifferenceAndFallsWithTheDistance) {
  double last = 0;
  for (const double step : {0.01, 0.05, 0.1, 0.2, 0.4}) {
    const double error = flipOf(grey(0.4), grey(0.4 + step));
    EXPECT_GT(error, last);
    last = error;
  }
  // A pattern as fine as the pixels is seen less and less with distance.
  const auto fine = picture([](int x, int y, int) { return (x + y) % 2 * 255; });
  const auto shifted = picture([](int x, int y, int) { return (x + y + 1) % 2 * 255; });
  last = 1;
  for (const double pixelsPerDegree : {10.0, 20.0, 40.0, 80.0}) {
    const double error = flipOf(fine, shifted, pixelsPerDegree);
    EXPECT_LT(error, last) << pixelsPerDegree;
    last = error;
  }
}

TEST(Flip, RefusesWhatItCannotCompare) {
  Image bad = grey(0.5), rgba = bad;
  bad.data[100] = std::numeric_limits<float>::quiet_NaN();
  rgba.channels = 4;
  rgba.data.resize(size_t(kWidth) * kHeight * 4);
  EXPECT_THROW(flip(bad, grey(0.5)), Error);
  EXPECT_THROW(flip(grey(0.5), bad), Error);
  EXPECT_THROW(flip(grey(0.5), Image{1, 1, 3, {0, 0, 0}}), Error);
  EXPECT_THROW(flip(rgba, rgba), Error);
  for (const double pixelsPerDegree : {0.0, -67.0, 1e9, std::nan("")})
    EXPECT_THROW(flip(grey(0.5), grey(0.5), pixelsPerDegree), Error);
}

}  // namespace
}  // namespace fovea::image
