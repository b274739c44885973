// Error measures of images against a reference, in the fovea, outside it, and over the whole image.
//
// T is what a screen shows: sRGB(clamp01(exposure * x)). The paper's MSE and MSE' (Eq. 4) are means over pixels and
// RGB of squared differences of T. A reference of finitely many samples has noise of its own, which adds to every
// error measured against it. In the mean of two independent halves, this noise is E[(h1 - h2)^2] / 4. If
// the halves are given, it is subtracted; a measure may then fall slightly below 0 by chance, but its mean over seeds
// stays correct. (T is curved, so with few samples this noise floor is off: by a tenth in either direction with 16 to
// 32 samples per pixel.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "fovea/compare.h"
#include "fovea/image.h"

namespace fovea::image {

// The fovea (see scene::Fovea): pixels whose centres are at most `radius` from the gaze. Everything is in pixels from
// the top left corner. The disc may lie outside the image.
struct Disc {
  float x = 0, y = 0, radius = 0;
  bool contains(uint32_t px, uint32_t py) const {
    const float dx = float(px) + 0.5f - x, dy = float(py) + 0.5f - y;
    return dx * dx + dy * dy <= radius * radius;
  }
};

// Throws Error(BadInput) if the images differ in size or number of channels, have no pixels,
// or contain NaN or infinity.
void checkComparable(const Image& a, const std::string& nameA, const Image& b, const std::string& nameB);

inline size_t pixelCount(const Image& image) { return size_t(image.width) * image.height; }
Image toRgb(const Image& image);                         // grey is repeated, alpha dropped
Image displayed(const Image& radiance, float exposure);  // T of every channel

// RGB in two forms. `radiance` is empty for an image that is already display-referred (a PNG).
struct Picture {
  Image radiance, display;
};
Picture fromRadiance(const Image& radiance, float exposure);
Picture fromDisplay(const Image& display);

// Two independent halves of a reference.
struct Halves {
  Picture a, b;
};

// Mean over pixels and RGB of the squared difference of T; NaN for a region without pixels. Throws
// as checkComparable() does.
PerRegion<double> meanSquaredError(const Picture& a, const Picture& b, const Disc& fovea);

// By how much blocks of pixels stand out in the picture, relative to the reference: 1 if they do not. For each picture, the
// squared differences of T between neighbouring pixels are averaged across the lines of a lattice of 8 pixels, and one
// pixel beside those lines; the ratio of the two means is divided by that of the reference. The same is done for 16
// pixels, and the larger result counts. It is NaN for a region without such lines, or if one of the pictures is uniform
// beside them. Throws as checkComparable() does.
PerRegion<double> blockiness(const Picture& image, const Picture& reference, const Disc& fovea);

// All images must have the size of the reference; otherwise throws Error(BadInput) as checkComparable() does.
PerRegion<Measures> compare(const Picture& image, const Picture& reference,
                            const std::optional<Halves>& halves, const Disc& fovea, double pixelsPerDegree);

// Means of T over pixels, RGB, and frames or pairs of consecutive frames. Each frame has its own fovea, and each pair
// that of its later frame; those in which the region has no pixels do not count.
struct SequenceMeasures {
  uint64_t pairs = 0;
  double mse = kUnknown, noiseFloor = kUnknown;  // as in Measures
  double change = kUnknown;           // MSE' (Eq. 4) of the sequence: its own flicker and the scene's motion
  double referenceChange = kUnknown;  // MSE' of the reference minus its noise: the scene's motion alone
  double excess = kUnknown;  // mean [((a_t - a_(t-1)) - (g_t - g_(t-1)))^2] minus the reference's noise
  double excessNoiseFloor = kUnknown;  // the reference's share of excess and referenceChange
};

// Compares two sequences frame by frame; holds two frames of each.
class SequenceComparison {
 public:
  // Either all frames have halves or none of them. Throws Error(BadInput) otherwise, and as compare() does.
  void add(Picture image, Picture reference, std::optional<Halves> halves, const Disc& fovea);
  uint64_t frames() const { return frames_; }
  // Throws Error(BadInput) if fewer than two frames were added.
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
