#include "framework/image/eyes.h"

#include <array>
#include <cmath>

#include "fovea/error.h"

namespace fovea::image {
namespace {

// Less than the least weight for which a layer `correspondence` calls a surface seen. A place that was rounded up to
// the centre of the next pixel may have no weight left.
constexpr double kLeastWeight = 1e-4;

[[noreturn]] void noPlace(const Image& correspondence, uint32_t x, uint32_t y) {
  throw Error(ExitCode::BadInput,
              "the correspondence of the eyes has (" + std::to_string(correspondence.at(x, y, 0)) + ", " +
                  std::to_string(correspondence.at(x, y, 1)) + ", " +
                  std::to_string(correspondence.at(x, y, 2)) + ") in pixel " + std::to_string(x) + ", " +
                  std::to_string(y) + ", which names no pixels of the other eye",
              "take the layer `correspondence` of the graph `alternatives/reference_stereo` at this size");
}

// The radiance of the right eye where it sees the surface of a pixel of the left one. Returns false if it does not.
bool sample(const Image& right, const Image& correspondence, uint32_t x, uint32_t y,
            std::array<float, 3>& radiance) {
  const float shown = correspondence.at(x, y, 2);
  if (shown == 0) return false;
  if (!(shown >= 1 && shown <= 15) || shown != std::floor(shown)) noPlace(correspondence, x, y);
  const double atX = double(correspondence.at(x, y, 0)) - 0.5, atY = double(correspondence.at(x, y, 1)) - 0.5;
  if (!(atX > -1 && atY > -1 && atX < right.width && atY < right.height)) noPlace(correspondence, x, y);
  const double firstX = std::floor(atX), firstY = std::floor(atY);
  std::array<double, 3> sum{};
  double weights = 0;
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t dx = i & 1, dy = i >> 1;
    const double weight = (1 - std::abs(firstX + dx - atX)) * (1 - std::abs(firstY + dy - atY));
    if ((uint32_t(shown) >> i & 1) == 0 || weight == 0) continue;
    const double px = firstX + dx, py = firstY + dy;
    if (px < 0 || py < 0 || px >= right.width || py >= right.height) noPlace(correspondence, x, y);
    weights += weight;
    for (uint32_t c = 0; c < 3; ++c) sum[c] += weight * right.at(uint32_t(px), uint32_t(py), c);
  }
  if (weights < kLeastWeight) return false;
  for (uint32_t c = 0; c < 3; ++c) radiance[c] = float(sum[c] / weights);
  return true;
}

// d of three channels per pixel, NaN where it is not known.
std::vector<float> differencesOf(const Picture& left, const Picture& right, const Image& correspondence,
                                 float exposure) {
  std::vector<float> d(left.display.data.size(), float(kUnknown));
  std::array<float, 3> radiance{};
  for (uint32_t y = 0; y < left.display.height; ++y)
    for (uint32_t x = 0; x < left.display.width; ++x)
      if (sample(right.radiance, correspondence, x, y, radiance))
        for (uint32_t c = 0; c < 3; ++c)
          d[(size_t(y) * left.display.width + x) * 3 + c] =
              left.display.at(x, y, c) - srgbEncode(exposure * radiance[c]);
  return d;
}

void checkEye(const EyePictures& eye, const std::string& name, const Image& correspondence) {
  const auto check = [&](const Picture& picture, const std::string& what) {
    if (picture.radiance.data.empty())
      throw Error(ExitCode::BadInput, what + " holds no radiance, of which the eyes are compared",
                  "compare pictures in .exr files");
    checkComparable(picture.radiance, what, correspondence, "the correspondence of the eyes");
  };
  check(*eye.image, "the picture of the " + name + " eye");
  check(*eye.reference, "the reference of the " + name + " eye");
  if (!eye.halves) return;
  check(eye.halves->a, "the first half of the reference of the " + name + " eye");
  check(eye.halves->b, "the second half of the reference of the " + name + " eye");
}

}  // namespace

void EyesComparison::add(const EyePictures& left, const EyePictures& right, const Image& correspondence,
                         float exposure, const Disc& fovea) {
  checkEye(left, "left", correspondence);
  checkEye(right, "right", correspondence);
  const auto of = [&](const Picture& l, const Picture& r) {
    return differencesOf(l, r, correspondence, exposure);
  };
  Differences now{of(*left.image, *right.image), of(*left.reference, *right.reference), {}, {}};
  if (left.halves && right.halves) {
    now.halfA = of(left.halves->a, right.halves->a);
    now.halfB = of(left.halves->b, right.halves->b);
  }
  if (frames_ > 0 && (correspondence.width != width_ || correspondence.height != height_))
    throw Error(ExitCode::BadInput, "the frames differ in size", "render all of them with the same --size");
  if (frames_ > 0 && now.halfA.empty() != last_.halfA.empty())
    throw Error(ExitCode::BadInput, "only some frames of the reference have halves of both eyes",
                "render all of them alike");
  width_ = correspondence.width, height_ = correspondence.height;
  addFrame(now, fovea);
  if (frames_ > 0) addPair(now, fovea);
  last_ = std::move(now);
  ++frames_;
}

template <class Value>
void EyesComparison::addSquares(Sum Sums::*sum, const Disc& fovea, Value value) {
  for (uint32_t y = 0; y < height_; ++y)
    for (uint32_t x = 0; x < width_; ++x) {
      double squares = 0;
      for (size_t i = (size_t(y) * width_ + x) * 3, end = i + 3; i < end; ++i) {
        const double v = value(i);
        squares += v * v / 3;
      }
      if (std::isnan(squares)) continue;
      for (Sums* region : {fovea.contains(x, y) ? &sums_.fovea : &sums_.periphery, &sums_.whole}) {
        (region->*sum).value += squares;
        ++(region->*sum).count;
      }
    }
}

void EyesComparison::addFrame(const Differences& now, const Disc& fovea) {
  for (uint32_t y = 0; y < height_; ++y)
    for (uint32_t x = 0; x < width_; ++x) ++(fovea.contains(x, y) ? sums_.fovea : sums_.periphery).pixels;
  sums_.whole.pixels += size_t(width_) * height_;
  addSquares(&Sums::difference, fovea, [&](size_t i) { return now.image[i]; });
  addSquares(&Sums::reference, fovea, [&](size_t i) { return now.reference[i]; });
  addSquares(&Sums::excess, fovea, [&](size_t i) { return double(now.image[i]) - now.reference[i]; });
  if (!now.halfA.empty())
    addSquares(&Sums::noise, fovea, [&](size_t i) { return (double(now.halfA[i]) - now.halfB[i]) / 2; });
}

void EyesComparison::addPair(const Differences& now, const Disc& fovea) {
  const Differences& before = last_;
  addSquares(&Sums::flicker, fovea, [&](size_t i) {
    return double(now.image[i]) - before.image[i] - (double(now.reference[i]) - before.reference[i]);
  });
  if (now.halfA.empty()) return;
  // The noise of the difference of two frames, so that noise they share does not count.
  addSquares(&Sums::flickerNoise, fovea, [&](size_t i) {
    return (double(now.halfA[i]) - before.halfA[i] - (double(now.halfB[i]) - before.halfB[i])) / 2;
  });
}

PerRegion<EyeMeasures> EyesComparison::result() const {
  const auto measures = [](const Sums& s) {
    EyeMeasures m;
    m.pixels = s.difference.count;
    if (s.pixels > 0) m.share = double(m.pixels) / double(s.pixels);
    m.difference = s.difference.mean();
    m.referenceDifference = s.reference.mean();
    m.excess = s.excess.mean();
    m.noiseFloor = s.noise.mean();
    m.flicker = s.flicker.mean();
    m.flickerNoiseFloor = s.flickerNoise.mean();
    if (s.noise.count > 0) m.referenceDifference -= m.noiseFloor, m.excess -= m.noiseFloor;
    if (s.flickerNoise.count > 0) m.flicker -= m.flickerNoiseFloor;
    return m;
  };
  return {measures(sums_.fovea), measures(sums_.periphery), measures(sums_.whole)};
}

std::vector<float> EyesComparison::pixelExcess() const {
  std::vector<float> errors(last_.image.size() / 3);
  for (size_t i = 0; i < errors.size(); ++i) {
    double squares = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double v = double(last_.image[c]) - last_.reference[c];
      squares += v * v / 3;
    }
    if (!std::isnan(squares)) errors[i] = float(std::sqrt(squares));
  }
  return errors;
}

std::vector<std::pair<const char*, double>> namedMeasures(const EyeMeasures& m, bool sequence) {
  std::vector<std::pair<const char*, double>> named = {{"share", m.share},
                                                       {"difference", m.difference},
                                                       {"reference_difference", m.referenceDifference},
                                                       {"excess", m.excess},
                                                       {"noise_floor", m.noiseFloor}};
  if (sequence)
    named.insert(named.end(), {{"flicker", m.flicker}, {"flicker_noise_floor", m.flickerNoiseFloor}});
  return named;
}

}  // namespace fovea::image
