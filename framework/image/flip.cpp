#include "framework/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fovea/error.h"
#include "framework/image/color.h"
#include "framework/image/metrics.h"

namespace fovea::image {
namespace {

constexpr double kPi = std::numbers::pi;

// Constants of the paper. Contrast sensitivities (FLIP 4.1.1, table 1) are sums of a sqrt(pi / b) exp(-pi^2 x^2 / b),
// x in degrees, for the achromatic, red-green and blue-yellow channels.
struct Bell {
  double a, b;
};
constexpr std::array<std::array<Bell, 2>, 3> kSensitivity = {
    {{{{1, 0.0047}, {0, 1e-5}}}, {{{1, 0.0053}, {0, 1e-5}}}, {{{34.1, 0.04}, {13.5, 0.025}}}}};
constexpr double kColorExponent = 0.7;  // q_c
constexpr double kKnee = 0.4,
                 kKneeValue = 0.95;       // p_c, p_t: errors above 0.4 of the greatest share the last 5%
constexpr double kFeatureExponent = 0.5;  // q_f
constexpr double kFeatureWidth = 0.082;   // w, degrees: of the edges the eye detects best

using Plane = std::vector<double>;
using Planes = std::array<Plane, 3>;
using Kernel = std::vector<double>;  // 2 radius + 1 taps

// Filters rows, then columns; outside the image the border continues.
Plane filtered(const Plane& in, uint32_t width, uint32_t height, const Kernel& alongX, const Kernel& alongY) {
  const int radius = int(alongX.size() / 2), w = int(width), h = int(height);
  Plane rows(in.size()), out(in.size(), 0.0);
  std::vector<double> line(width + 2 * size_t(radius));
  for (int y = 0; y < h; ++y) {
    const double* row = &in[size_t(y) * width];
    for (int i = 0; i < int(line.size()); ++i) line[size_t(i)] = row[std::clamp(i - radius, 0, w - 1)];
    for (int x = 0; x < w; ++x) {
      double sum = 0;
      for (size_t k = 0; k < alongX.size(); ++k) sum += alongX[k] * line[size_t(x) + k];
      rows[size_t(y) * width + size_t(x)] = sum;
    }
  }
  for (int y = 0; y < h; ++y)
    for (size_t k = 0; k < alongY.size(); ++k) {
      const double* row = &rows[size_t(std::clamp(y + int(k) - radius, 0, h - 1)) * width];
      double* result = &out[size_t(y) * width];
      for (uint32_t x = 0; x < width; ++x) result[x] += alongY[k] * row[x];
    }
  return out;
}

// ---- Colour (FLIP 4.1)
// -------------------------------------------------------------------------------------------

Planes toYcxcz(const Image& image) {
  Planes planes;
  for (Plane& plane : planes) plane.resize(pixelCount(image));
  for (size_t i = 0; i < pixelCount(image); ++i) {
    Color rgb;
    for (size_t c = 0; c < 3; ++c) rgb[c] = srgbDecode(image.data[3 * i + c]);
    const Color ycxcz = ycxczFromXyz(xyzFromLinear(rgb));
    for (size_t c = 0; c < 3; ++c) planes[c][i] = ycxcz[c];
  }
  return planes;
}

// Filters one channel as the eye resolves it. Each of its bells is separable; their common support is a square, and
// the weights of all of them together sum to 1.
Plane blurred(const Plane& in, uint32_t width, uint32_t height, const std::array<Bell, 2>& bells,
              double pixelsPerDegree) {
  // The widest bell of all channels determines the radius (FLIP 4.1.1): three standard deviations.
  double widest = 0;
  for (const auto& channel : kSensitivity)
    for (const Bell& bell : channel) widest = std::max(widest, bell.b);
  const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * kPi * kPi)) * pixelsPerDegree));
  Plane out(in.size(), 0.0);
  double total = 0;
  for (const Bell& bell : bells) {
    if (bell.a == 0) continue;
    Kernel kernel;
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double degrees = i / pixelsPerDegree;
      kernel.push_back(std::exp(-kPi * kPi * degrees * degrees / bell.b));
      sum += kernel.back();
    }
    const double scale = bell.a * std::sqrt(kPi / bell.b);
    total += scale * sum * sum;
    const Plane part = filtered(in, width, height, kernel, kernel);
    for (size_t i = 0; i < out.size(); ++i) out[i] += scale * part[i];
  }
  for (double& value : out) value /= total;
  return out;
}

// CIELAB with the Hunt effect: darker surfaces look less colourful.
Color huntLab(const Color& linear) {
  Color lab = labFromXyz(xyzFromLinear(linear));
  lab[1] *= 0.01 * lab[0];
  lab[2] *= 0.01 * lab[0];
  return lab;
}

// HyAB distance, which is designed for large differences.
double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

std::vector<Color> seenColors(const Planes& ycxcz, const Image& image, double pixelsPerDegree) {
  Planes planes;
  for (size_t c = 0; c < 3; ++c)
    planes[c] = blurred(ycxcz[c], image.width, image.height, kSensitivity[c], pixelsPerDegree);
  std::vector<Color> colors(pixelCount(image));
  for (size_t i = 0; i < colors.size(); ++i) {
    Color rgb = linearFromXyz(xyzFromYcxcz({planes[0][i], planes[1][i], planes[2][i]}));
    for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
    colors[i] = huntLab(rgb);
  }
  return colors;
}

// Maps to 0..1. The greatest possible error is that between pure green and pure blue.
double redistributed(double distance) {
  static const double greatest = std::pow(hyab(huntLab({0, 1, 0}), huntLab({0, 0, 1})), kColorExponent);
  const double knee = kKnee * greatest, error = std::pow(distance, kColorExponent);
  return error < knee ? kKneeValue / knee * error
                      : kKneeValue + (error - knee) / (greatest - knee) * (1 - kKneeValue);
}

// ---- Features (FLIP 4.2)
// -----------------------------------------------------------------------------------------

struct Features {
  Plane edges, points;
};

// Lengths of the first and second derivatives of the luminance, smoothed to the width that the eye detects best. The
// positive weights of each kernel sum to 1, the negative ones to -1.
Features features(const Planes& ycxcz, const Image& image, double pixelsPerDegree) {
  const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = int(std::ceil(3 * sigma));
  Kernel smooth, first, second;
  double sum = 0, firstSum = 0, rises = 0, falls = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double bell = std::exp(-i * i / (2 * sigma * sigma));
    smooth.push_back(bell);
    first.push_back(-i * bell);
    second.push_back((i * i / (sigma * sigma) - 1) * bell);
    sum += bell;
    firstSum += std::max(first.back(), 0.0);
    rises += std::max(second.back(), 0.0);
    falls -= std::min(second.back(), 0.0);
  }
  for (double& k : smooth) k /= sum;
  for (double& k : first) k /= firstSum;
  for (double& k : second) k /= k > 0 ? rises : falls;
  Plane luminance(ycxcz[0]);
  for (double& y : luminance) y = (y + 16) / 116;
  const auto length = [&](const Kernel& derivative) {
    Plane result = filtered(luminance, image.width, image.height, derivative, smooth);
    const Plane down = filtered(luminance, image.width, image.height, smooth, derivative);
    for (size_t i = 0; i < result.size(); ++i) result[i] = std::hypot(result[i], down[i]);
    return result;
  };
  return {length(first), length(second)};
}

}  // namespace

std::vector<float> flip(const Image& reference, const Image& test, double pixelsPerDegree) {
  if (!(pixelsPerDegree >= 1 && pixelsPerDegree <= 1000))
    throw Error(ExitCode::BadInput, "pixels per degree go from 1 to 1000",
                "67 is a screen of 3840 pixels as far away as it is wide");
  checkComparable(test, "the picture", reference, "the reference");
  if (reference.channels != 3) throw Error(ExitCode::BadInput, "FLIP compares RGB pictures");
  const Planes a = toYcxcz(reference), b = toYcxcz(test);
  const std::vector<Color> seenA = seenColors(a, reference, pixelsPerDegree),
                           seenB = seenColors(b, test, pixelsPerDegree);
  const Features featuresA = features(a, reference, pixelsPerDegree),
                 featuresB = features(b, test, pixelsPerDegree);
  std::vector<float> map(pixelCount(reference));
  for (size_t i = 0; i < map.size(); ++i) {
    const double color = redistributed(hyab(seenA[i], seenB[i]));
    const double feature = std::pow(std::max(std::abs(featuresA.edges[i] - featuresB.edges[i]),
                                             std::abs(featuresA.points[i] - featuresB.points[i])) /
                                        std::numbers::sqrt2,
                                    kFeatureExponent);
    // Where features differ, a difference in colour counts more (FLIP 4.3).
    map[i] = float(std::pow(color, 1 - std::min(feature, 1.0)));
  }
  return map;
}

}  // namespace fovea::image
