#include "framework/image/color.h"

#include <algorithm>
#include <cmath>

#include "fovea/image.h"

namespace fovea::image {
namespace {

// From the chromaticities of IEC 61966-2-1: primaries (0.64, 0.33), (0.30, 0.60), (0.15, 0.06), white (0.3127, 0.3290).
constexpr double kToXyz[3][3] = {{0.41239079926596, 0.35758433938388, 0.18048078840183},
                                 {0.21263900587151, 0.71516867876776, 0.07219231536073},
                                 {0.01933081871559, 0.11919477979463, 0.95053215224966}};
constexpr double kFromXyz[3][3] = {{3.24096994190452, -1.53738317757009, -0.49861076029300},
                                   {-0.96924363628088, 1.87596750150772, 0.04155505740718},
                                   {0.05563007969699, -0.20397695888898, 1.05697151424288}};

Color multiply(const double (&m)[3][3], const Color& v) {
  Color result{};
  for (size_t i = 0; i < 3; ++i) result[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return result;
}

// The compression of CIELAB: a cube root with a linear segment near black.
constexpr double kDelta = 6.0 / 29;

double compress(double t) {
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

double expand(double f) { return f > kDelta ? f * f * f : 3 * kDelta * kDelta * (f - 4.0 / 29); }

}  // namespace

float srgbEncode(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

float srgbDecode(float encoded) {
  const float x = std::clamp(encoded, 0.0f, 1.0f);
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

Color xyzFromLinear(const Color& rgb) { return multiply(kToXyz, rgb); }
Color linearFromXyz(const Color& xyz) { return multiply(kFromXyz, xyz); }

const Color& whiteXyz() {
  static const Color white = xyzFromLinear({1, 1, 1});
  return white;
}

Color labFromXyz(const Color& xyz) {
  const Color& white = whiteXyz();
  const double x = compress(xyz[0] / white[0]), y = compress(xyz[1] / white[1]),
               z = compress(xyz[2] / white[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color xyzFromLab(const Color& lab) {
  const Color& white = whiteXyz();
  const double y = (lab[0] + 16) / 116;
  return {white[0] * expand(y + lab[1] / 500), white[1] * expand(y), white[2] * expand(y - lab[2] / 200)};
}

Color ycxczFromXyz(const Color& xyz) {
  const Color& white = whiteXyz();
  const double x = xyz[0] / white[0], y = xyz[1] / white[1], z = xyz[2] / white[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color xyzFromYcxcz(const Color& c) {
  const Color& white = whiteXyz();
  const double y = (c[0] + 16) / 116;
  return {white[0] * (y + c[1] / 500), white[1] * y, white[2] * (y - c[2] / 200)};
}

}  // namespace fovea::image
