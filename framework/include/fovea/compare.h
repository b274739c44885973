// How far pictures are from their references, in the fovea, outside it, and over the whole picture.
//
//   const image::PerRegion<image::Measures> errors = image::compare(image::read("a.exr"), image::read("reference.exr"));
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/image.h"

namespace fovea::image {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <class T>
struct PerRegion {
  T fovea, periphery, whole;
};

// NaN means unknown, as in a region without pixels.
struct Measures {
  uint64_t pixels = 0;
  double mse = kUnknown;   // of the displayed picture, minus noiseFloor if known
  double psnr = kUnknown;  // dB below 1; infinite where mse is not above 0
  // Mean of (a - g)^2 / (g + 0.01)^2 of the radiance, minus relMseNoiseFloor if known.
  double relMse = kUnknown;
  double flip = kUnknown;        // mean of LDR-FLIP, including the reference's noise
  double blocks = kUnknown;      // by how much blocks of pixels stand out, see framework/image/metrics.h
  double noiseFloor = kUnknown;  // the reference's share of mse
  double relMseNoiseFloor = kUnknown;
};
// The measures but for `pixels`, by the names that they have in JSON and in Python, in this order.
std::vector<std::pair<const char*, double>> namedMeasures(const Measures& measures);

// What is not set follows from the metadata of the picture, else of the reference, else it has its default.
struct CompareOptions {
  std::string layer;              // "radiance", or the only layer
  std::optional<glm::vec2> gaze;  // normalised image coordinates, origin top-left; the middle
  std::optional<float> radius;    // of the fovea, image widths; 0.25
  std::optional<float> exposure;  // display = sRGB(exposure * radiance); 1
  double pixelsPerDegree = 67;    // of visual angle, for FLIP
};

// The halves `half_a` and `half_b` of the reference, if it has them, give the noise that is subtracted. Throws
// Error(BadInput) on missing layers, different sizes, channels that are no colours, NaN or infinity.
PerRegion<Measures> compare(const File& image, const File& reference, const CompareOptions& options = {});

}  // namespace fovea::image
