// By how much the eyes of a stereo picture disagree beyond parallax.
//
// For a pixel p of the left eye whose surface the right eye sees at the place q of its picture,
//   d(p) = T(L(p)) - T(R(q)),
// where T is what a screen shows (metrics.h), and R(q) is bilinear in radiance among those of the four pixels around q
// that show the same surface. d is not 0 even if all light is exact, because R is interpolated between pixels, and
// because what smooth surfaces reflect depends on where the eye is. Therefore the measure that judges a method is the
// excess, the mean square of the difference between d and that of the reference. If two independent halves of the
// reference are known, its noise E[(d_1 - d_2)^2] / 4 is subtracted, with d_1 of the first half of both eyes. Noise
// that both eyes of a half have in common thus cancels out here as it does in d.
#pragma once

#include "framework/image/metrics.h"

namespace fovea::image {

// The pictures of one eye that are compared; none is owned.
struct EyePictures {
  const Picture *image = nullptr, *reference = nullptr;
  const Halves* halves = nullptr;  // of the reference; null if they are not known
};

// Means over pixels, RGB, and frames or pairs of consecutive frames.
struct EyeMeasures {
  uint64_t pixels = 0;                    // of the left eye that are compared, in all frames together
  double share = kUnknown;                // of the region's pixels that are compared
  double difference = kUnknown;           // mean of d^2
  double referenceDifference = kUnknown;  // the same of the reference, minus noiseFloor if known
  double excess = kUnknown;               // mean of (d - d of the reference)^2, minus noiseFloor if known
  double noiseFloor = kUnknown;           // the reference's share of excess and referenceDifference
  // Mean of (change of d - change of the reference's d)^2 from frame to frame at pixels that are compared in both
  // frames, minus flickerNoiseFloor if known; of a single frame it is not known.
  double flicker = kUnknown;
  double flickerNoiseFloor = kUnknown;
};

// Compares the eyes frame by frame; holds d of one frame.
class EyesComparison {
 public:
  // correspondence: for each pixel of the left eye, r and g: the place in the right picture that shows its surface,
  // pixels from the top left corner; b: which of the four pixels around that place show it, the sum of 1, 2, 4 and 8
  // row by row, or 0 if the right eye does not see it. It has the size of the pictures. exposure: of T; fovea: of the
  // left eye. Either all frames have halves of both eyes or none does. Throws Error(BadInput) otherwise, if sizes
  // differ, if a picture holds no radiance, on NaN or infinity, and if the correspondence names a place that is not in
  // the picture.
  void add(const EyePictures& left, const EyePictures& right, const Image& correspondence, float exposure,
           const Disc& fovea);
  uint64_t frames() const { return frames_; }
  PerRegion<EyeMeasures> result() const;
  // Root of the mean over RGB of (d - d of the reference)^2 in the last frame, one value per pixel; 0 where pixels are
  // not compared.
  std::vector<float> pixelExcess() const;

 private:
  // d of three channels per pixel, NaN where it is not known; empty if there are no halves.
  struct Differences {
    std::vector<float> image, reference, halfA, halfB;
  };
  struct Sum {
    double value = 0;
    uint64_t count = 0;  // of pixels
    double mean() const { return count == 0 ? kUnknown : value / double(count); }
  };
  struct Sums {
    Sum difference, reference, excess, noise, flicker, flickerNoise;
    uint64_t pixels = 0;  // of the region
  };
  // Adds up the mean over RGB of the square of value(index) for the pixels of each region where it is known.
  template <class Value>
  void addSquares(Sum Sums::*sum, const Disc& fovea, Value value);
  void addFrame(const Differences& now, const Disc& fovea);
  void addPair(const Differences& now, const Disc& fovea);

  uint64_t frames_ = 0;
  uint32_t width_ = 0, height_ = 0;  // of the pictures
  Differences last_;
  PerRegion<Sums> sums_;
};

// The measures by their names in JSON, in this order; those of the changes only if there are several frames.
std::vector<std::pair<const char*, double>> namedMeasures(const EyeMeasures& measures, bool sequence);

}  // namespace fovea::image
