// Compares path-trace with pictures of Mitsuba 3 (tests/data/mitsuba/README.md), a renderer with which it shares no
// code. samples/compare_with_mitsuba.py made the pictures and does the same comparison with more samples.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>

#include "fovea/error.h"
#include "fovea/image.h"
#include "fovea/scene.h"
#include "framework/scene/frame.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/path_tracer.h"
#include "places.h"

namespace fovea::test {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(FOVEA_TEST_DATA) / "mitsuba";

// The mean of each channel of each pixel, and its precision.
struct Estimate {
  std::vector<double> mean, variance;
};

struct Mitsuba : Estimate {
  glm::uvec2 size{0};
  double degrees = 0;  // of freedom of the variance
};

Mitsuba readMitsuba(const std::string& name) {
  const image::File file = image::read(kFolder / (name + ".exr"));
  const image::Image &mean = *file.find(""), &deviation = *file.find("deviation");
  Mitsuba m;
  m.size = {mean.width, mean.height};
  m.degrees = std::stod(file.metadata.at("batches")) - 1;
  m.mean.assign(mean.data.begin(), mean.data.end());
  for (const float d : deviation.data) m.variance.push_back(double(d) * d);
  return m;
}

Estimate trace(const scene::Scene& scene, glm::uvec2 size, uint32_t samples, bool full) {
  const scene::Geometry geometry = scene::flatten(scene);
  const scene::Frame frame = scene::makeFrame(scene, geometry, size, 0, 1);
  const size_t pixels = size_t(size.x) * size.y;
  std::vector<glm::vec4> radiance(pixels), variance(pixels);
  path_trace::PathTraceSettings settings;
  settings.samples = samples;
  settings.seed = 1;
  settings.independent = settings.box = true;
  settings.full = full;
  path_trace::PathTraceImages images;
  images.radiance = radiance;
  images.variance = variance;
  const scene::RayScene rays(scene, geometry, full ? scene::Passing::Met : scene::Passing::Never);
  path_trace::tracePaths(frame, frame.views[0], rays, settings, images);
  Estimate e;
  for (size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) {
      e.mean.push_back(radiance[i][c]);
      e.variance.push_back(variance[i][c]);
    }
  return e;
}

// Welch's t of two means, transformed to the normal distribution (Wallace 1959). The tracer's variance, from all of
// its samples, counts as known. The tolerance includes the precision of 16-bit images and the order of sums.
// alike: the difference that counts as none.
double zValue(const Mitsuba& m, const Estimate& e, size_t i, double alike) {
  constexpr double kArithmetic = 1e-3;
  const double floor = kArithmetic * std::max(m.mean[i], e.mean[i]),
               difference = std::max(std::abs(m.mean[i] - e.mean[i]) - alike, 0.0);
  const double total = m.variance[i] + e.variance[i] + floor * floor + 1e-12;
  const double freedom = m.degrees * total * total / std::max(m.variance[i] * m.variance[i], 1e-60);
  return std::sqrt(freedom * std::log1p(difference * difference / total / freedom)) * (8 * freedom + 1) /
         (8 * freedom + 3);
}

// Two-sided test of all channels together at a level of 1% (Sidak 1967): the normal quantile by bisection.
double zLimit(size_t tests) {
  const double each = 1 - std::pow(0.99, 1.0 / double(tests));
  double low = 0, high = 20;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    (std::erfc(z / std::sqrt(2.0)) > each ? low : high) = z;
  }
  return low;
}

void compare(const scene::Scene& scene, const std::string& name, uint32_t samples, bool full = false) {
  const Mitsuba want = readMitsuba(name);
  const Estimate got = trace(scene, want.size, samples, full);
  ASSERT_EQ(want.mean.size(), got.mean.size());
  const double limit = zLimit(want.mean.size());
  // Mitsuba lacks what light that is scattered more than once among microfacets adds.
  double alike = 0;
  if (full)
    for (const double m : want.mean) alike += 0.02 * m / double(want.mean.size());
  double sum = 0, wanted = 0, rejected = 0;
  for (size_t i = 0; i < want.mean.size(); i += 3) {
    double largest = 0;
    for (size_t c = i; c < i + 3; ++c) {
      sum += got.mean[c];
      wanted += want.mean[c];
      largest = std::max(largest, zValue(want, got, c, alike));
    }
    rejected += largest > limit;
  }
  rejected /= double(want.mean.size()) / 3;
  testing::Test::RecordProperty("difference", std::to_string(sum / wanted - 1));
  testing::Test::RecordProperty("rejected", std::to_string(rejected));
  EXPECT_NEAR(sum / wanted, 1, full ? 0.01 : 0.005);
  EXPECT_LE(rejected, 0.0025);
}

TEST(PathTraceMitsuba, CornellBox) { compare(scene::builtin("cornellbox"), "cornellbox", 512); }

// Directional, point and spot light, emissive triangles on one and on both sides, a mask, texture transforms.
TEST(PathTraceMitsuba, EveryLight) {
  Diagnostics warnings;
  compare(scene::load((kFolder / "every_light.json").string(), warnings), "every_light", 512);
}

// One part of full materials each; the README beside the pictures says how far both renderers mean the same.
class PathTraceMitsubaMaterials : public testing::TestWithParam<const char*> {};

TEST_P(PathTraceMitsubaMaterials, LookAlike) {
  Diagnostics warnings;
  const std::string name = std::string("materials/") + GetParam();
  // With fewer samples the noise of the mean comes close to the limit for it.
  compare(scene::load((kFolder / (name + ".json")).string(), warnings), name, 1024, true);
}

INSTANTIATE_TEST_SUITE_P(Long, PathTraceMitsubaMaterials,
                         testing::Values("base_color", "metal", "rough", "half_metal", "normal", "emissive",
                                         "alpha", "blend"),
                         [](const auto& info) { return std::string(info.param); });

TEST(LongPathTraceMitsuba, Sponza) {
  Diagnostics warnings;
  scene::Scene scene;
  try {
    scene = scene::load("sponza", warnings);
  } catch (const Error& error) {
    GTEST_SKIP() << "no Sponza here: " << error.what();
  }
  compare(scene, "sponza", 512);
}

}  // namespace
}  // namespace fovea::test
