// Tests both eyes from end to end: the right eye made from the light of the left one, against the right eye rendered
// on its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "fovea/scene.h"
#include "framework/scene/load.h"
#include "places.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSide = 256;

// Pages with the same VPLs in every frame and run, since light paths do not depend on the eye.
const std::vector<std::string> kSettings = {"vpl_count=320", "map_size=32", "shadow_map_size=512",
                                            "per_frame=false"};

GraphRun run(const std::string& graph, const scene::Scene& s, const std::string& view, int interleave = 4,
             uint32_t frames = 1) {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = frames;
  options.set = kSettings;
  options.set.push_back("interleave=" + std::to_string(interleave));
  // The view that the graph takes for its only one.
  if (!view.empty())
    options.beforeFrame = [view](scene::Frame& frame) {
      const std::string name = frame.views[0].name;
      frame.views[0] = *frame.findView(view);
      frame.views[0].name = name;
    };
  return runGraph(graph, s, options);
}

double counter(const GraphRun& run, const std::string& name) {
  for (const auto& [n, value] : run.frames.back().counters)
    if (n == name) return value;
  ADD_FAILURE() << "no counter " << name;
  return 0;
}

double luminance(const std::vector<float>& image, size_t i) {
  return 0.2126 * image[4 * i] + 0.7152 * image[4 * i + 1] + 0.0722 * image[4 * i + 2];
}

struct Errors {
  double mean = 0, p95 = 0, bias = 0;  // of luminance, in parts of the picture's mean
};

// Mean over the pixels with mask != 0 (`in`) or mask == 0.
Errors compare(const std::vector<float>& image, const std::vector<float>& want,
               const std::vector<float>& mask, bool in) {
  double brightness = 0;
  for (size_t i = 0; i < mask.size(); ++i) brightness += luminance(want, i) / double(mask.size());
  std::vector<double> errors;
  Errors e;
  for (size_t i = 0; i < mask.size(); ++i) {
    if ((mask[i] > 0) != in) continue;
    const double difference = (luminance(image, i) - luminance(want, i)) / brightness;
    e.bias += difference;
    e.mean += std::abs(difference);
    errors.push_back(std::abs(difference));
  }
  if (errors.empty()) return e;
  e.bias /= double(errors.size());
  e.mean /= double(errors.size());
  const auto at = errors.begin() + std::ptrdiff_t(0.95 * double(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end());
  e.p95 = *at;
  return e;
}

class Interleave : public testing::TestWithParam<int> {};

// Without interleaving only the error of the warp itself is left: it is bilinear between pixels, and shadows of VPLs
// are a pixel off. With interleaving both pictures have their own noise from subsets.
TEST_P(Interleave, RightEyeEqualsTheOneRenderedOnItsOwn) {
  const int n = GetParam();
  const scene::Scene s = scene::builtin("cornellbox");
  const GraphRun both = run("ir_stereo", s, "", n), own = run("ir_1000", s, "right", n),
                 left = run("ir_1000", s, "left", n);
  // The first eye does not depend on the second; direct light is never warped.
  EXPECT_EQ(both.outputs.at("radiance").bytes, left.outputs.at("radiance").bytes);
  EXPECT_EQ(both.outputs.at("direct_right").bytes, own.outputs.at("direct").bytes);

  const auto image = toFloats(both.outputs.at("indirect_right")), want = toFloats(own.outputs.at("indirect"));
  const auto mask = toFloats(both.outputs.at("mask"));
  const double pixels = counter(both, "right/reproject.pixels"),
               fresh = counter(both, "right/reproject.new_pixels") / pixels,
               shaded = counter(both, "right/reproject.shaded_pixels") / pixels;
  const Errors warped = compare(image, want, mask, false), again = compare(image, want, mask, true);
  std::printf(
      "new %.2f%%, shaded %.2f%%; warped: mean %.4f p95 %.4f bias %.4f; shaded: mean %.4f p95 %.4f bias "
      "%.4f\n",
      100 * fresh, 100 * shaded, warped.mean, warped.p95, warped.bias, again.mean, again.p95, again.bias);
  EXPECT_EQ(counter(both, "right/deferred.shaded_pixels"), shaded * pixels);
  EXPECT_GT(fresh, 0.005);
  EXPECT_LT(fresh, 0.03);
  EXPECT_LT(shaded, n == 1 ? 0.03 : 0.05);
  EXPECT_LT(warped.mean, n == 1 ? 0.006 : 0.015);
  EXPECT_LT(warped.p95, n == 1 ? 0.02 : 0.05);
  EXPECT_LT(std::abs(warped.bias), 0.003);
  EXPECT_LT(again.mean, n == 1 ? 1e-6 : 0.02);  // newly shaded pixels are the same in both
  EXPECT_LT(again.p95, n == 1 ? 1e-6 : 0.08);
  EXPECT_LT(std::abs(again.bias), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Stereo, Interleave, testing::Values(1, 4));

TEST(Stereo, RepeatsBitForBit) {
  const scene::Scene s = scene::builtin("cornellbox");
  const GraphRun a = run("ir_stereo", s, "", 4, 2), b = run("ir_stereo", s, "", 4, 2);
  EXPECT_EQ(a.outputs.at("radiance_right").bytes, b.outputs.at("radiance_right").bytes);
  EXPECT_EQ(a.outputs.at("mask").bytes, b.outputs.at("mask").bytes);
}

// The foveated method: the second eye against the same eye shaded completely with the same VPLs.
TEST(Stereo, FoveatedSecondEyeEqualsAllOfItShaded) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "stereo_whole.json";
  std::ofstream(file) << R"({"extends": ")" FOVEA_SOURCE_DIR R"(/graphs/stereo.json",
    "passes": {"whole": {"type": "deferred", "inputs": {"gbuffer": "right.gbuffer", "vpls": "vpl-intensity.emitters", "atlas": "shadow-atlas"},
                         "params": {"kernel": "$kernel", "clamp_distance": "$clamp_distance",
                                    "clamp_unit": "$clamp_unit", "interleave": "$interleave"}}},
    "outputs": {"whole": "whole.indirect"}})";
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = 3;
  options.set = {"vpl_count=320", "map_size=32", "shadow_map_size=512", "voxels=48", "interleave=1"};
  const GraphRun both = runGraph(file.string(), scene::builtin("cornellbox"), options);
  const auto image = toFloats(both.outputs.at("indirect_right")), want = toFloats(both.outputs.at("whole"));
  const auto mask = toFloats(both.outputs.at("mask"));
  const Errors warped = compare(image, want, mask, false), again = compare(image, want, mask, true);
  std::printf("warped: mean %.4f p95 %.4f bias %.4f\n", warped.mean, warped.p95, warped.bias);
  EXPECT_GT(counter(both, "right/reproject.new_pixels"), 0);
  EXPECT_LT(warped.mean, 0.006);
  EXPECT_LT(warped.p95, 0.02);
  EXPECT_LT(again.p95, 1e-6);
}

double meanSquaredError(const std::vector<float>& image, const std::vector<float>& want) {
  double sum = 0;
  for (size_t i = 0; i < image.size(); ++i)
    if (i % 4 < 3) sum += std::pow(image[i] - want[i], 2);
  return sum / (0.75 * double(image.size()));
}

// The full method: the first eye does not know of the second, and the second is about as close to what it should see
// as the first is.
TEST(Stereo, SecondEyeOfFovealIsAsGoodAsTheFirst) {
  const scene::Scene s = scene::builtin("cornellbox");
  GraphRunOptions options;
  options.size = {96, 96};
  options.frames = 6;
  options.set = {"vpl_count=320", "map_size=32", "shadow_map_size=512", "voxels=48"};
  const GraphRun both = runGraph("foveal_stereo", s, options);
  const auto look = [](const std::string& view) {
    return [view](scene::Frame& frame) {
      frame.views[0] = *frame.findView(view);
      frame.views[0].name = "main";
    };
  };
  options.beforeFrame = look("left");
  const GraphRun left = runGraph("foveal", s, options);
  EXPECT_EQ(both.outputs.at("radiance").bytes, left.outputs.at("radiance").bytes);

  const auto errorOf = [&](const std::string& view, const std::string& output) {
    GraphRunOptions exact = options;
    exact.set = {"spp=256"};
    exact.frames = 1;  // nothing moves
    exact.beforeFrame = look(view);
    const GraphRun truth = runGraph("reference", s, exact);
    return meanSquaredError(toFloats(both.outputs.at(output)), toFloats(truth.outputs.at("indirect")));
  };
  const double first = errorOf("left", "indirect"), second = errorOf("right", "indirect_right");
  std::printf("mean squared error of the first eye %.3g, of the second %.3g\n", first, second);
  EXPECT_LT(second, 1.15 * first);
  EXPECT_GT(counter(both, "right/near-field.pixels"), 0);
  EXPECT_LT(counter(both, "right/near-field.pixels"), 0.05 * counter(both, "right/reproject.pixels"));
}

class BuiltinStereo : public testing::TestWithParam<const char*> {};

// Thin things, curtains, leaves and the border that only the second eye sees, against the same eye shaded completely
// with the same VPLs.
TEST_P(BuiltinStereo, SecondEyeEqualsAllOfItShaded) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "ir_stereo_whole.json";
  std::ofstream(file) << R"({"extends": ")" FOVEA_SOURCE_DIR R"(/graphs/ir_stereo.json",
    "passes": {"whole": {"type": "deferred", "inputs": {"gbuffer": "right.gbuffer", "vpls": "emit", "atlas": "shadow-atlas"},
                         "params": {"kernel": "$kernel", "clamp_distance": "$clamp_distance",
                                    "clamp_unit": "$clamp_unit", "interleave": "$interleave"}}},
    "outputs": {"whole": "whole.indirect"}})";
  const GraphRun both = run(file.string(), scene::builtin(GetParam()), "", 1);
  const auto image = toFloats(both.outputs.at("indirect_right")), want = toFloats(both.outputs.at("whole"));
  const auto all = std::vector<float>(size_t(kSide) * kSide, 1);
  std::vector<float> border(all.size());  // of the right eye: what the left one's image does not hold
  for (size_t i = 0; i < all.size(); ++i) border[i] = i % kSide >= kSide - 4;
  for (size_t i = 0; i < image.size(); ++i) ASSERT_TRUE(std::isfinite(image[i])) << "texel " << i / 4;
  const double pixels = counter(both, "right/reproject.pixels"),
               fresh = counter(both, "right/reproject.new_pixels") / pixels,
               filled = counter(both, "right/reproject.filled_pixels") / pixels,
               shaded = counter(both, "right/reproject.shaded_pixels") / pixels;
  const Errors errors = compare(image, want, all, true), atBorder = compare(image, want, border, true);
  std::printf(
      "%s: new %.2f%%, filled %.2f%%, shaded %.2f%%; mean %.4f p95 %.4f bias %.4f; border %.4f %.4f\n",
      GetParam(), 100 * fresh, 100 * filled, 100 * shaded, errors.mean, errors.p95, errors.bias,
      atBorder.mean, atBorder.bias);
  EXPECT_GT(fresh, 0.005);
  EXPECT_LT(fresh, 0.1);
  EXPECT_GT(filled, 0.1 * fresh);
  EXPECT_LT(shaded, 0.07);  // leaves close to the eye
  EXPECT_LT(errors.mean, 0.04);
  EXPECT_LT(std::abs(errors.bias), 0.01);
  EXPECT_LT(atBorder.mean, 0.1);
  EXPECT_LT(std::abs(atBorder.bias), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Stereo, BuiltinStereo, testing::Values("atrium", "room", "yard", "balcony"));

// Each eye sees further outwards than inwards. A wide strip is seen only by the right eye, and in all of it the
// result equals that of the right eye rendered on its own.
TEST(Stereo, ThroughALens) {
  scene::Scene s = scene::builtin("cornellbox");
  s.lens = scene::Lens{0.5f, 0.35f, 0.4f, 0.4f};
  s.cameras[0].position.z = 2;  // in the box: no background
  const GraphRun both = run("ir_stereo", s, "", 1), own = run("ir_1000", s, "right", 1);
  EXPECT_EQ(both.outputs.at("direct_right").bytes, own.outputs.at("direct").bytes);
  const auto image = toFloats(both.outputs.at("indirect_right")), want = toFloats(own.outputs.at("indirect"));
  const auto mask = toFloats(both.outputs.at("mask"));
  const Errors warped = compare(image, want, mask, false), again = compare(image, want, mask, true);
  const double fresh = counter(both, "right/reproject.new_pixels") / counter(both, "right/reproject.pixels");
  std::printf("new %.2f%%; warped: mean %.4f p95 %.4f\n", 100 * fresh, warped.mean, warped.p95);
  const double strip = (std::tan(0.5) - std::tan(0.35)) / (std::tan(0.5) + std::tan(0.35));
  EXPECT_GT(fresh, strip);
  EXPECT_LT(fresh, strip + 0.03);
  EXPECT_LT(warped.mean, 0.006);
  EXPECT_LT(again.mean, 1e-6);
}

// An empty scene leaves nothing to warp and nothing to shade.
TEST(Stereo, EmptySceneIsBlack) {
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  const GraphRun empty = run("ir_stereo", s, "");
  for (float x : toFloats(empty.outputs.at("indirect_right"))) ASSERT_TRUE(x == 0 || x == 1);
  EXPECT_EQ(counter(empty, "right/reproject.shaded_pixels"), 0);
}

}  // namespace
}  // namespace fovea::test
