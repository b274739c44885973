// Tests error pictures: their colours keep the order of the errors, the errors are in their places, and the legend
// and the circle are drawn.
#include "framework/image/error_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/error.h"

namespace fovea::image {
namespace {

double lightness(const Color& encoded) {
  Color linear;
  for (size_t c = 0; c < 3; ++c) linear[c] = srgbDecode(float(encoded[c]));
  return labFromXyz(xyzFromLinear(linear))[0];
}

TEST(Colors, SpacesMatchTheStandard) {
  const Color& white = whiteXyz();
  EXPECT_NEAR(white[0], 0.95046, 1e-5);
  EXPECT_NEAR(white[1], 1, 1e-9);
  EXPECT_NEAR(white[2], 1.08906, 1e-5);
  // CIELAB of sRGB's primaries under D65, as listed in colorimetric tables.
  const Color primaries[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Color expected[] = {{53.24, 80.09, 67.20}, {87.74, -86.18, 83.18}, {32.30, 79.19, -107.86}};
  for (size_t i = 0; i < 3; ++i) {
    const Color lab = labFromXyz(xyzFromLinear(primaries[i]));
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(lab[c], expected[i][c], 0.02) << i << c;
  }
  for (const Color& rgb : {Color{0.2, 0.5, 0.9}, Color{0.001, 0, 0.002}, Color{1, 1, 1}}) {
    const Color xyz = xyzFromLinear(rgb), lab = xyzFromLab(labFromXyz(xyz)),
                y = xyzFromYcxcz(ycxczFromXyz(xyz)), back = linearFromXyz(xyz);
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(lab[c], xyz[c], 1e-9);
      EXPECT_NEAR(y[c], xyz[c], 1e-12);
      EXPECT_NEAR(back[c], rgb[c], 1e-9);
    }
  }
}

TEST(ErrorPicture, ColoursGrowLighterEvenly) {
  for (int i = 0; i <= 100; ++i) {
    const Color color = mapColor(i / 100.0);
    for (const double c : color) EXPECT_TRUE(c >= 0 && c <= 1);
    // Colours slightly outside the screen's gamut are clipped, hence the tolerance.
    EXPECT_NEAR(lightness(color), 4 + 92 * i / 100.0, 2) << i;
    EXPECT_TRUE(i == 0 || lightness(color) > lightness(mapColor((i - 1) / 100.0))) << i;
  }
  EXPECT_EQ(mapColor(7), mapColor(1));
  EXPECT_EQ(mapColor(-1), mapColor(0));
  EXPECT_EQ(mapColor(std::nan("")), mapColor(0));
}

TEST(ErrorPicture, ErrorsAreRootsOfMeanSquares) {
  const Image a{2, 1, 3, {0, 0, 0, 0.5f, 0.5f, 0.5f}}, b{2, 1, 3, {0.3f, 0, 0.4f, 0.5f, 0.5f, 0.5f}};
  const std::vector<float> errors = pixelErrors(fromDisplay(a), fromDisplay(b));
  EXPECT_NEAR(errors[0], std::sqrt(0.25 / 3), 1e-7);
  EXPECT_EQ(errors[1], 0);
  EXPECT_THROW(pixelErrors(fromDisplay(a), fromDisplay(Image{1, 1, 3, {0, 0, 0}})), Error);
}

TEST(ErrorPicture, ShowsErrorsCircleAndScale) {
  std::vector<float> values(size_t(128) * 32, 0.0f);
  values[3 * 128 + 5] = 0.05f;
  const Image plain = errorPicture(values, 128, 0.1);
  EXPECT_EQ(plain.width, 128u);
  ASSERT_GT(plain.height, 32u + 10) << "the legend";
  for (uint32_t c = 0; c < 3; ++c) {
    EXPECT_FLOAT_EQ(plain.at(5, 3, c), float(mapColor(0.5)[c]));
    EXPECT_FLOAT_EQ(plain.at(6, 3, c), float(mapColor(0)[c]));
    EXPECT_NEAR(plain.at(2, 34, c), mapColor(0)[c], 0.04) << "the scale's left end";
    EXPECT_NEAR(plain.at(125, 34, c), mapColor(1)[c], 0.04) << "its right end";
  }
  // "0", "0.05" and "0.1": dots of ink below the scale's ends and its middle.
  for (const uint32_t left : {0u, 56u, 112u}) {
    int ink = 0;
    for (uint32_t y = 40; y < plain.height; ++y)
      for (uint32_t x = left; x < left + 16; ++x) ink += plain.at(x, y, 0) > 0.5f;
    EXPECT_GT(ink, 8) << left;
  }
  const Disc fovea{64, 16, 10};
  const Image circled = errorPicture(values, 128, 0.1, &fovea);
  EXPECT_GT(circled.at(74, 16, 0), 0.4f) << "the circle";
  EXPECT_FLOAT_EQ(circled.at(69, 16, 0), plain.at(69, 16, 0));
  EXPECT_EQ(errorPicture(std::vector<float>(64, 0.0f), 8, 1).height, 8u) << "too small for a legend";
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(errorPicture(values, 128, bad), Error);
}

}  // namespace
}  // namespace fovea::image
