#include "framework/image/metrics.h"

#include <algorithm>
#include <cmath>

#include "fovea/error.h"
#include "framework/image/color.h"
#include "framework/image/flip.h"

namespace fovea::image {
namespace {

constexpr double kDark = 0.01;  // radiance below which an error no longer counts in proportion

struct RegionMean {
  double sum = 0;
  uint64_t pixels = 0;
  double mean() const { return pixels == 0 ? kUnknown : sum / double(pixels); }
};

// Sums the `error` of every pixel, row by row.
template <class Error>
PerRegion<RegionMean> regionMeans(const Image& size, const Disc& fovea, Error error) {
  PerRegion<RegionMean> means;
  for (uint32_t y = 0; y < size.height; ++y)
    for (uint32_t x = 0; x < size.width; ++x) {
      const double e = error(size_t(y) * size.width + x);
      RegionMean& region = fovea.contains(x, y) ? means.fovea : means.periphery;
      region.sum += e;
      region.pixels++;
    }
  means.whole = {means.fovea.sum + means.periphery.sum, means.fovea.pixels + means.periphery.pixels};
  return means;
}

// Mean over RGB of the squares of difference(index of the value).
template <class Difference>
PerRegion<RegionMean> meanSquares(const Image& size, const Disc& fovea, Difference difference) {
  return regionMeans(size, fovea, [&](size_t pixel) {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double d = difference(3 * pixel + c);
      sum += d * d;
    }
    return sum / 3;
  });
}

PerRegion<RegionMean> displayErrors(const Picture& a, const Picture& b, const Disc& fovea) {
  return meanSquares(a.display, fovea,
                     [&](size_t i) { return double(a.display.data[i]) - b.display.data[i]; });
}

PerRegion<RegionMean> relativeErrors(const Picture& a, const Picture& b, const Picture& reference,
                                     const Disc& fovea) {
  return meanSquares(a.radiance, fovea, [&](size_t i) {
    return (double(a.radiance.data[i]) - b.radiance.data[i]) / (double(reference.radiance.data[i]) + kDark);
  });
}

// Applies `f` to the same region of each argument.
template <class F, class First, class... More>
void forRegions(F f, First& first, More&&... more) {
  f(first.fovea, more.fovea...);
  f(first.periphery, more.periphery...);
  f(first.whole, more.whole...);
}

void checkPictures(const Picture& image, const Picture& reference, const std::optional<Halves>& halves) {
  const auto check = [&](const Picture& picture, const char* name) {
    checkComparable(picture.display, name, reference.display, "the reference");
    if (!picture.radiance.data.empty() && !reference.radiance.data.empty())
      checkComparable(picture.radiance, name, reference.radiance, "the reference");
  };
  check(image, "the picture");
  if (!halves) return;
  check(halves->a, "the first half of the reference");
  check(halves->b, "the second half of the reference");
}

void checkFinite(const Image& image, const std::string& name) {
  const auto bad =
      std::find_if(image.data.begin(), image.data.end(), [](float v) { return !std::isfinite(v); });
  if (bad == image.data.end()) return;
  const size_t pixel = size_t(bad - image.data.begin()) / image.channels;
  const std::string place = std::to_string(pixel % image.width) + ", " + std::to_string(pixel / image.width);
  throw Error(ExitCode::BadInput,
              name + " has a NaN or infinity in pixel " + place + " and cannot be compared",
              "find the pass that made it");
}

double psnrOf(double mse) {
  if (std::isnan(mse)) return kUnknown;
  return mse > 0 ? -10 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

}  // namespace

void checkComparable(const Image& a, const std::string& nameA, const Image& b, const std::string& nameB) {
  const auto size = [](const Image& i) {
    return std::to_string(i.width) + "x" + std::to_string(i.height) + " with " + std::to_string(i.channels) +
           " channels";
  };
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw Error(ExitCode::BadInput,
                nameA + " and " + nameB + " differ in size: " + size(a) + " and " + size(b),
                "render both with the same --size");
  if (pixelCount(a) == 0 || a.channels == 0)
    throw Error(ExitCode::BadInput, nameA + " is empty and cannot be compared");
  checkFinite(a, nameA);
  checkFinite(b, nameB);
}

Image toRgb(const Image& image) {
  if (image.channels == 3) return image;
  Image rgb{image.width, image.height, 3, std::vector<float>(pixelCount(image) * 3)};
  for (size_t i = 0; i < pixelCount(image); ++i)
    for (size_t c = 0; c < 3; ++c)
      rgb.data[3 * i + c] = image.data[i * image.channels + (image.channels > 3 ? c : 0)];
  return rgb;
}

Image displayed(const Image& radiance, float exposure) {
  Image display = radiance;
  for (float& value : display.data)  // clamping would hide infinities
    value = std::isfinite(value) ? srgbEncode(exposure * value) : kUnknown;
  return display;
}

Picture fromRadiance(const Image& radiance, float exposure) {
  Image rgb = toRgb(radiance);
  Image display = displayed(rgb, exposure);
  return {std::move(rgb), std::move(display)};
}

Picture fromDisplay(const Image& display) { return {{}, toRgb(display)}; }

PerRegion<double> meanSquaredError(const Picture& a, const Picture& b, const Disc& fovea) {
  checkComparable(a.display, "the first picture", b.display, "the second picture");
  PerRegion<double> result{};
  forRegions([](double& mse, const RegionMean& mean) { mse = mean.mean(); }, result,
             displayErrors(a, b, fovea));
  return result;
}

namespace {

// Squared differences of neighbouring pixels across the lines of a lattice, and beside them.
struct Jumps {
  RegionMean across, beside;
  double ratio() const { return beside.sum > 0 ? across.mean() / beside.mean() : kUnknown; }
};

// The mean over RGB of the squared difference between a pixel and the one before it along an axis, which is `step` values
// apart.
double squaredJump(const Image& display, size_t pixel, size_t step) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double d = double(display.data[3 * pixel + c]) - display.data[3 * (pixel - step) + c];
    sum += d * d / 3;
  }
  return sum;
}

PerRegion<Jumps> jumpsOf(const Image& display, const Disc& fovea, uint32_t side) {
  PerRegion<Jumps> jumps;
  const auto add = [&](uint32_t x, uint32_t y, uint32_t along, uint32_t size, size_t step) {
    const uint32_t place = along % side;  // of the second of the two pixels
    if (along < 2 || along + 1 >= size || (place != 0 && place != 1 && place != side - 1)) return;
    const double jump = squaredJump(display, size_t(y) * display.width + x, step);
    Jumps& region = fovea.contains(x, y) ? jumps.fovea : jumps.periphery;
    for (Jumps* j : {&region, &jumps.whole}) {
      RegionMean& mean = place == 0 ? j->across : j->beside;
      mean.sum += jump;
      ++mean.pixels;
    }
  };
  for (uint32_t y = 0; y < display.height; ++y)
    for (uint32_t x = 0; x < display.width; ++x) {
      add(x, y, x, display.width, 1);
      add(x, y, y, display.height, display.width);
    }
  return jumps;
}

}  // namespace

PerRegion<double> blockiness(const Picture& image, const Picture& reference, const Disc& fovea) {
  checkComparable(image.display, "the picture", reference.display, "the reference");
  PerRegion<double> result{kUnknown, kUnknown, kUnknown};
  for (const uint32_t side : {8u, 16u})
    forRegions([](double& blocks, const Jumps& its,
                  const Jumps& reference) { blocks = std::fmax(blocks, its.ratio() / reference.ratio()); },
               result, jumpsOf(image.display, fovea, side), jumpsOf(reference.display, fovea, side));
  return result;
}

PerRegion<Measures> compare(const Picture& image, const Picture& reference,
                            const std::optional<Halves>& halves, const Disc& fovea, double pixelsPerDegree) {
  checkPictures(image, reference, halves);
  PerRegion<Measures> result;
  forRegions(
      [](Measures& m, const RegionMean& mean) {
        m.pixels = mean.pixels;
        m.mse = mean.mean();
      },
      result, displayErrors(image, reference, fovea));
  if (halves)
    forRegions(
        [](Measures& m, const RegionMean& mean) {
          m.noiseFloor = mean.mean() / 4;
          m.mse -= m.noiseFloor;
        },
        result, displayErrors(halves->a, halves->b, fovea));
  forRegions([](Measures& m) { m.psnr = psnrOf(m.mse); }, result);
  forRegions([](Measures& m, double blocks) { m.blocks = blocks; }, result,
             blockiness(image, reference, fovea));

  const bool linear = !image.radiance.data.empty() && !reference.radiance.data.empty();
  if (linear)
    forRegions([](Measures& m, const RegionMean& mean) { m.relMse = mean.mean(); }, result,
               relativeErrors(image, reference, reference, fovea));
  if (linear && halves && !halves->a.radiance.data.empty() && !halves->b.radiance.data.empty())
    forRegions(
        [](Measures& m, const RegionMean& mean) {
          m.relMseNoiseFloor = mean.mean() / 4;
          m.relMse -= m.relMseNoiseFloor;
        },
        result, relativeErrors(halves->a, halves->b, reference, fovea));

  const std::vector<float> map = flip(reference.display, image.display, pixelsPerDegree);
  forRegions([](Measures& m, const RegionMean& mean) { m.flip = mean.mean(); }, result,
             regionMeans(reference.display, fovea, [&](size_t pixel) { return double(map[pixel]); }));
  return result;
}

// ---- Sequences
// ---------------------------------------------------------------------------------------------------

void SequenceComparison::Sum::add(double v) {
  if (std::isnan(v)) return;
  value += v;
  ++count;
}

void SequenceComparison::add(Picture image, Picture reference, std::optional<Halves> halves,
                             const Disc& fovea) {
  checkPictures(image, reference, halves);
  Frame now{std::move(image), std::move(reference), std::move(halves)};
  if (previous_) {
    checkComparable(now.reference.display, "frame " + std::to_string(frames_), previous_->reference.display,
                    "the frame before it");
    if (now.halves.has_value() != previous_->halves.has_value())
      throw Error(ExitCode::BadInput, "only some frames of the reference have halves",
                  "render all of them alike");
    addPair(now, fovea);
  }
  addFrame(now, fovea);
  previous_ = std::move(now);
  ++frames_;
}

void SequenceComparison::addFrame(const Frame& now, const Disc& fovea) {
  forRegions([](Sums& s, const RegionMean& mean) { s.mse.add(mean.mean()); }, sums_,
             displayErrors(now.image, now.reference, fovea));
  if (!now.halves) return;
  forRegions([](Sums& s, const RegionMean& mean) { s.noise.add(mean.mean() / 4); }, sums_,
             displayErrors(now.halves->a, now.halves->b, fovea));
}

void SequenceComparison::addPair(const Frame& now, const Disc& fovea) {
  const Frame& before = *previous_;
  const auto step = [](const Picture& a, const Picture& b, size_t i) {
    return double(a.display.data[i]) - b.display.data[i];
  };
  forRegions([](Sums& s, const RegionMean& mean) { s.change.add(mean.mean()); }, sums_,
             displayErrors(now.image, before.image, fovea));
  forRegions([](Sums& s, const RegionMean& mean) { s.referenceChange.add(mean.mean()); }, sums_,
             displayErrors(now.reference, before.reference, fovea));
  forRegions([](Sums& s, const RegionMean& mean) { s.excess.add(mean.mean()); }, sums_,
             meanSquares(now.image.display, fovea, [&](size_t i) {
               return step(now.image, before.image, i) - step(now.reference, before.reference, i);
             }));
  if (!now.halves) return;
  // The noise of the difference of two frames, so that noise they share does not count.
  forRegions([](Sums& s, const RegionMean& mean) { s.excessNoise.add(mean.mean() / 4); }, sums_,
             meanSquares(now.image.display, fovea, [&](size_t i) {
               return step(now.halves->a, before.halves->a, i) - step(now.halves->b, before.halves->b, i);
             }));
}

PerRegion<SequenceMeasures> SequenceComparison::result() const {
  if (frames_ < 2)
    throw Error(ExitCode::BadInput, "a sequence of fewer than two frames has no changes to compare",
                "render it with --frames");
  PerRegion<SequenceMeasures> result;
  forRegions(
      [](SequenceMeasures& m, const Sums& s) {
        m.pairs = s.change.count;
        m.mse = s.mse.mean();
        m.noiseFloor = s.noise.mean();
        m.change = s.change.mean();
        m.referenceChange = s.referenceChange.mean();
        m.excess = s.excess.mean();
        m.excessNoiseFloor = s.excessNoise.mean();
        if (s.noise.count > 0) m.mse -= m.noiseFloor;
        if (s.excessNoise.count == 0) return;
        m.referenceChange -= m.excessNoiseFloor;
        m.excess -= m.excessNoiseFloor;
      },
      result, sums_);
  return result;
}

std::vector<std::pair<const char*, double>> namedMeasures(const Measures& m) {
  return {{"mse", m.mse},
          {"psnr", m.psnr},
          {"relmse", m.relMse},
          {"flip", m.flip},
          {"blocks", m.blocks},
          {"noise_floor", m.noiseFloor},
          {"relmse_noise_floor", m.relMseNoiseFloor}};
}

}  // namespace fovea::image
