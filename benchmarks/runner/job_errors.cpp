// Errors of the pictures and sequences of a job.
#include <cmath>
#include <numeric>
#include <optional>

#include "benchmarks/runner/job.h"
#include "framework/image/error_picture.h"
#include "framework/image/eyes.h"
#include "framework/image/flip.h"
#include "framework/image/metrics.h"
#include "framework/session/compared.h"

namespace fovea::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kErrorScale = 0.1, kTemporalScale = 0.02;  // errors of the lightest colour in error pictures
constexpr const char* kIndirect = "indirect";

// null if it is not known.
Json known(double value) { return std::isfinite(value) ? Json(value) : Json(); }

double sumOf(const image::Image& radiance) {
  return std::accumulate(radiance.data.begin(), radiance.data.end(), 0.0);
}

double lightOf(const session::Compared& c) { return sumOf(c.image.radiance) / sumOf(c.reference.radiance); }

std::vector<float> changeErrors(const image::Picture& now, const image::Picture& before,
                                const image::Picture& wanted, const image::Picture& wantedBefore) {
  std::vector<float> errors(size_t(now.display.width) * now.display.height);
  for (size_t i = 0; i < errors.size(); ++i) {
    double sum = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double d = double(now.display.data[c]) - before.display.data[c] -
                       (double(wanted.display.data[c]) - wantedBefore.display.data[c]);
      sum += d * d;
    }
    errors[i] = float(std::sqrt(sum / 3));
  }
  return errors;
}

// Errors of the indirect light as it was rendered, and after it was scaled so that its sum is that of the reference;
// `light` is the ratio of these sums before.
struct IndirectErrors {
  image::PerRegion<image::Measures> asRendered, scaled;
  double light = image::kUnknown;
};

image::PerRegion<image::Measures> measuresOf(const session::Compared& c) {
  return image::compare(c.image, c.reference, c.halves, c.fovea, image::kDefaultPixelsPerDegree);
}

IndirectErrors indirectErrors(image::File picture, const image::File& truth,
                              session::CompareOptions options) {
  options.layer = kIndirect;
  const session::Compared asRendered =
      session::compareRadiance("picture", picture, "reference", truth, options);
  IndirectErrors errors{measuresOf(asRendered), {}, lightOf(asRendered)};
  if (!(errors.light > 0) || !std::isfinite(errors.light)) return errors;
  for (image::Layer& layer : picture.layers)
    if (layer.name == kIndirect)
      for (float& value : layer.image.data) value = float(value / errors.light);
  errors.scaled = measuresOf(session::compareRadiance("picture", picture, "reference", truth, options));
  return errors;
}

Json regionOf(const image::Measures& m, const image::Measures* indirect, const image::Measures* scaled,
              double directFloor) {
  return {{"mse", known(m.mse)},
          {"psnr", known(m.psnr)},
          {"flip", known(m.flip)},
          {"blocks", known(indirect ? indirect->blocks : m.blocks)},
          {"relmse", indirect ? known(indirect->relMse) : Json()},
          {"indirect_mse", indirect ? known(indirect->mse) : Json()},
          {"scaled_indirect_mse", scaled ? known(scaled->mse) : Json()},
          {"noise_floor", known(m.noiseFloor)},
          {"direct_floor", known(directFloor)}};
}

Json regionOf(const image::SequenceMeasures& m, const image::SequenceMeasures* indirect) {
  return {{"mse", known(m.mse)},
          {"mse_prime", known(m.change)},
          {"excess", known(m.excess)},
          {"indirect_mse_prime", indirect ? known(indirect->change) : Json()},
          {"indirect_excess", indirect ? known(indirect->excess) : Json()},
          {"reference_mse_prime", known(m.referenceChange)},
          {"noise_floor", known(m.noiseFloor)},
          {"excess_noise_floor", known(m.excessNoiseFloor)}};
}

Json regionOf(const image::EyeMeasures& m, bool sequence) {
  Json json = {{"pixels", m.pixels}};
  for (const auto& [name, value] : image::namedMeasures(m, sequence)) json[name] = known(value);
  return json;
}

}  // namespace

Json BenchRunner::errors(const Job& job, const image::File& last) {
  const uint64_t frame = uint64_t(job.first) + job.frames - 1;
  const image::File truth = reference(job, frame);
  progress_.stage("measuring");
  session::CompareOptions options;
  options.layer = job.layer;
  const session::Compared c = session::compareRadiance("picture", last, "reference", truth, options);
  const image::PerRegion<image::Measures> whole = measuresOf(c);
  std::optional<IndirectErrors> indirect;
  if (last.find(kIndirect)) indirect = indirectErrors(last, truth, options);
  image::PerRegion<double> floor{image::kUnknown, image::kUnknown, image::kUnknown};
  if (c.perfectIndirect) floor = image::meanSquaredError(*c.perfectIndirect, c.reference, c.fovea);
  if (job.pictures) {
    const uint32_t width = c.image.display.width;
    writePicture(job.name(), c.image.display);
    writePicture(job.name() + "-reference", c.reference.display);
    writePicture(job.name() + "-error",
                 image::errorPicture(image::pixelErrors(c.image, c.reference), width, kErrorScale, &c.fovea));
  }
  const auto region = [&](auto of) {
    return regionOf(of(whole), indirect ? &of(indirect->asRendered) : nullptr,
                    indirect ? &of(indirect->scaled) : nullptr, of(floor));
  };
  return {{"fovea", region([](auto& r) -> auto& { return r.fovea; })},
          {"periphery", region([](auto& r) -> auto& { return r.periphery; })},
          {"whole", region([](auto& r) -> auto& { return r.whole; })},
          {"light", known(lightOf(c))},
          {"indirect_light", known(indirect ? indirect->light : image::kUnknown)},
          {"disc", {c.fovea.x, c.fovea.y, c.fovea.radius}}};
}

Json BenchRunner::temporal(const Job& job, const Sequence& sequence) {
  image::SequenceComparison whole, indirect;
  session::Compared previous;
  session::CompareOptions options, indirectOptions;
  options.layer = job.layer, indirectOptions.layer = kIndirect;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const image::File& frame = sequence.frames[i];
    const image::File truth = reference(job, job.first + i);
    session::Compared c = session::compareRadiance("picture", frame, "reference", truth, options);
    if (job.pictures && i > 0 && i + 1 == sequence.frames.size())
      writePicture(job.name() + "-temporal",
                   image::errorPicture(changeErrors(c.image, previous.image, c.reference, previous.reference),
                                       c.image.display.width, kTemporalScale, &c.fovea));
    if (i + 2 == sequence.frames.size()) previous = c;
    whole.add(std::move(c.image), std::move(c.reference), std::move(c.halves), c.fovea);
    if (!frame.find(kIndirect)) continue;
    session::Compared l = session::compareRadiance("picture", frame, "reference", truth, indirectOptions);
    indirect.add(std::move(l.image), std::move(l.reference), std::move(l.halves), l.fovea);
  }
  const auto all = whole.result();
  std::optional<image::PerRegion<image::SequenceMeasures>> light;
  if (indirect.frames() > 1) light = indirect.result();
  return {{"fovea", regionOf(all.fovea, light ? &light->fovea : nullptr)},
          {"periphery", regionOf(all.periphery, light ? &light->periphery : nullptr)},
          {"whole", regionOf(all.whole, light ? &light->whole : nullptr)}};
}

// Of the last frame, or of all frames if they were kept.
Json BenchRunner::eyes(const Job& job, const Sequence& sequence) {
  const uint64_t first = uint64_t(job.first) + job.frames - sequence.frames.size();
  session::CompareOptions options;
  options.layer = job.layer;
  image::EyesComparison comparison;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const image::File truth = reference(job, first + i);
    progress_.stage("measuring");
    const session::ComparedEyes pair =
        session::compareEyes("picture", sequence.frames[i], "reference", truth, options);
    pair.addTo(comparison);
    if (job.pictures && i + 1 == sequence.frames.size())
      writePicture(job.name() + "-eyes",
                   image::errorPicture(comparison.pixelExcess(), pair.correspondence.width, kErrorScale,
                                       &pair.left.fovea));
  }
  const auto all = comparison.result();
  return {{"fovea", regionOf(all.fovea, job.temporal)},
          {"periphery", regionOf(all.periphery, job.temporal)},
          {"whole", regionOf(all.whole, job.temporal)}};
}

}  // namespace fovea::bench
