// Error measures of pictures against a reference, in the fovea, outside it, and over the whole picture.
//
// T is what a screen shows: sRGB(clamp01(exposure * x)). The paper's MSE and MSE' (Eq. 4) are means over
// pixels and RGB of squares of differences of T. A reference of finite samples has noise of its own, which
// adds to every error measured with it: from two independent halves of it, whose mean it is, the noise is
// E[(h1 - h2)^2] / 4. Where halves are given it is subtracted, so that a measure may come out slightly below
// 0 by chance, and its mean over seeds stays right. (T is curved: with few samples the floor is off,
// by a tenth one way or the other with 16 to 32 samples a pixel.)
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "fovea/image.h"

namespace fovea::image {

// The fovea: pixels whose centre is no farther than `radius` from the gaze, in pixels from the top left
// corner (a scene::Fovea). It may lie outside the picture.
struct Disc {
  float x = 0, y = 0, radius = 0;
  bool contains(uint32_t px, uint32_t py) const {
    const float dx = float(px) + 0.5f - x, dy = float(py) + 0.5f - y;
    return dx * dx + dy * dy <= radius * radius;
  }
};

// Throws Error(BadInput) on pictures of different size or number of channels, without pixels, or with a NaN
// or infinity.
void checkComparable(const Image& a, const std::string& nameA, const Image& b, const std::string& nameB);

Image toRgb(const Image& image);                         // grey is repeated, alpha dropped
Image displayed(const Image& radiance, float exposure);  // T of every channel

// RGB, twice: `radiance` is empty for a picture that is display-referred already (a PNG).
struct Picture {
  Image radiance, display;
};
Picture fromRadiance(const Image& radiance, float exposure);
Picture fromDisplay(const Image& display);

// Two independent halves of a reference.
struct Halves {
  Picture a, b;
};

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <class T>
struct PerRegion {
  T fovea, periphery, whole;
};

// Mean over pixels and RGB of the square of the difference of T; NaN in a region without pixels. Throws as
// checkComparable().
PerRegion<double> meanSquaredError(const Picture& a, const Picture& b, const Disc& fovea);

// NaN: not known, as in a region without pixels.
struct Measures {
  uint64_t pixels = 0;
  double mse = kUnknown;   // of T, less noiseFloor where known
  double psnr = kUnknown;  // dB below 1; infinite where mse is not above 0
  double relMse =
      kUnknown;  // mean of (a - g)^2 / (g + 0.01)^2 of the radiance, less relMseNoiseFloor where known
  double flip = kUnknown;        // mean of flip(); the reference's noise is in it
  double noiseFloor = kUnknown;  // the reference's part of mse
  double relMseNoiseFloor = kUnknown;
};

// All with the size of the reference, else Error(BadInput) as from checkComparable().
PerRegion<Measures> compare(const Picture& image, const Picture& reference,
                            const std::optional<Halves>& halves, const Disc& fovea, double pixelsPerDegree);

// Means of T over pixels, RGB, and frames or pairs of consecutive frames (each frame with its own fovea, each
// pair with that of its later frame; those in which the region has no pixels do not count).
struct SequenceMeasures {
  uint64_t pairs = 0;
  double mse = kUnknown, noiseFloor = kUnknown;  // as in Measures
  double change = kUnknown;           // MSE' (Eq. 4) of the sequence: its own flicker and the scene's motion
  double referenceChange = kUnknown;  // MSE' of the reference, less its noise: the scene's motion alone
  double excess = kUnknown;  // mean [((a_t - a_(t-1)) - (g_t - g_(t-1)))^2], less the reference's noise
  double excessNoiseFloor = kUnknown;  // the reference's part of excess and referenceChange
};

// Frame by frame; holds two frames of each sequence.
class SequenceComparison {
 public:
  // Either all frames have halves, or none. Throws Error(BadInput) otherwise, and as compare() does.
  void add(Picture image, Picture reference, std::optional<Halves> halves, const Disc& fovea);
  uint64_t frames() const { return frames_; }
  // Throws Error(BadInput) after fewer than two frames.
  PerRegion<SequenceMeasures> result() const;

 private:
  struct Sum {
    double value = 0;
    uint64_t count = 0;
    void add(double v);  // NaN does not count
    double mean() const { return count == 0 ? kUnknown : value / double(count); }
  };
  struct Sums {
    Sum mse, noise, change, referenceChange, excess, excessNoise;
  };
  struct Frame {
    Picture image, reference;
    std::optional<Halves> halves;
  };
  void addFrame(const Frame& now, const Disc& fovea);
  void addPair(const Frame& now, const Disc& fovea);

  uint64_t frames_ = 0;
  std::optional<Frame> previous_;
  PerRegion<Sums> sums_;
};

}  // namespace fovea::image
