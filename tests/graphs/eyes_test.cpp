// Tests the reference for two eyes, and that its eyes agree where both see a surface.
#include <gtest/gtest.h>

#include "fovea/scene.h"
#include "framework/image/eyes.h"
#include "framework/scene/load.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSide = 96;
constexpr float kExposure = 1;

GraphRun run(const std::string& graph, const std::string& view = "") {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.set = {"spp=32"};
  if (!view.empty())
    options.beforeFrame = [view](scene::Frame& frame) {
      const std::string name = frame.views[0].name;
      frame.views[0] = *frame.findView(view);
      frame.views[0].name = name;
    };
  return runGraph(graph, scene::builtin("cornellbox"), options);
}

// The pictures of one eye: those of a layer, its halves, and the layer with all light times `factor` to compare.
struct OneEye {
  image::Picture image, reference;
  image::Halves halves;

  OneEye(const GraphRun& run, const std::string& eye, float factor = 1)
      : image(picture(run, "radiance" + eye, factor)),
        reference(picture(run, "radiance" + eye)),
        halves{picture(run, "half_a" + eye), picture(run, "half_b" + eye)} {}

  static image::Picture picture(const GraphRun& run, const std::string& output, float factor = 1) {
    image::Image radiance = image::toRgb(session::toImage(run.outputs.at(output)));
    for (float& value : radiance.data) value *= factor;
    return image::fromRadiance(radiance, kExposure);
  }
};

image::EyeMeasures compare(const GraphRun& run, const OneEye& left, const OneEye& right, bool noise) {
  image::EyesComparison comparison;
  comparison.add({&left.image, &left.reference, noise ? &left.halves : nullptr},
                 {&right.image, &right.reference, noise ? &right.halves : nullptr},
                 image::toRgb(session::toImage(run.outputs.at("correspondence"))), kExposure, {});
  return comparison.result().whole;
}

TEST(ReferenceStereo, EyesAreThoseOfReference) {
  const GraphRun both = run("alternatives/reference_stereo");
  for (const std::string view : {"left", "right"}) {
    const GraphRun own = run("reference", view);
    for (const std::string output : {"radiance", "direct", "indirect", "half_a", "half_b", "image"})
      EXPECT_EQ(both.outputs.at(view == "left" ? output : output + "_right").bytes,
                own.outputs.at(output).bytes)
          << view << ", " << output;
  }
}

// The eyes are side by side: a surface is in the same row, and farther to the left for the right eye.
TEST(ReferenceStereo, SurfacesAreInTheSameRow) {
  const std::vector<float> places =
      toFloats(run("alternatives/reference_stereo").outputs.at("correspondence"));
  size_t seen = 0;
  for (size_t i = 0; i < places.size() / 4; ++i) {
    if (places[4 * i + 2] == 0) continue;
    ++seen;
    const double disparity = double(i % kSide) + 0.5 - places[4 * i];
    ASSERT_GT(disparity, 0.2) << "pixel " << i;
    ASSERT_LT(disparity, 6) << "pixel " << i;
    ASSERT_NEAR(places[4 * i + 1], double(i / kSide) + 0.5, 1e-3) << "pixel " << i;
  }
  EXPECT_GT(double(seen), 0.9 * kSide * kSide);
}

// What is left in the diffuse box, apart from noise, are the edges of shadows, which are sharp, between pixels.
TEST(ReferenceStereo, EyesOfADiffuseSceneAgree) {
  const GraphRun both = run("alternatives/reference_stereo");
  const OneEye left(both, ""), right(both, "_right");
  const image::EyeMeasures m = compare(both, left, right, true);
  std::printf("share %.3f, difference %.3g, of it noise %.3g\n", m.share, m.referenceDifference,
              m.noiseFloor);
  EXPECT_GT(m.share, 0.9);
  EXPECT_LT(std::abs(m.referenceDifference), 1e-3);
  EXPECT_EQ(compare(both, left, right, false).excess, 0);
  // Without the correspondence, the eyes disagree much more.
  image::Image same(image::toRgb(session::toImage(both.outputs.at("correspondence"))));
  for (size_t i = 0; i < same.data.size() / 3; ++i) {
    if (same.data[3 * i + 2] == 0) continue;
    same.data[3 * i] = float(i % kSide) + 0.5f;
    same.data[3 * i + 2] = 1;
  }
  image::EyesComparison blind;
  blind.add({&left.image, &left.reference, &left.halves}, {&right.image, &right.reference, &right.halves},
            same, kExposure, {});
  EXPECT_GT(blind.result().whole.referenceDifference, 5 * std::abs(m.referenceDifference));
}

// A tint of one eye shows, and one of both eyes hardly.
TEST(ReferenceStereo, AChangeInOneEyeShows) {
  const GraphRun both = run("alternatives/reference_stereo");
  const OneEye left(both, ""), right(both, "_right"), brightLeft(both, "", 1.1f),
      brightRight(both, "_right", 1.1f);
  const double one = compare(both, left, brightRight, false).excess,
               two = compare(both, brightLeft, brightRight, false).excess;
  std::printf("one eye brighter: %.3g, both: %.3g\n", one, two);
  EXPECT_GT(one, 1e-4);
  EXPECT_LT(two, 0.1 * one);
}

}  // namespace
}  // namespace fovea::test
