// Tests `foveal_quad`: the pictures of a wide view and an inset for each eye, each against the same picture made on its own.
#include <gtest/gtest.h>

#include <cstdio>

#include "fovea/scene.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

constexpr const char* kViews[] = {"left", "right", "left_inset", "right_inset"};
constexpr const char* kOutputs[] = {"radiance", "radiance_right", "radiance_inset", "radiance_right_inset"};

scene::Scene box() {
  scene::Scene s = scene::builtin("cornellbox");
  s.lens = scene::Lens{0.5f, 0.5f, 0.5f, 0.4f};  // so that both eyes look at the same place
  s.cameras[0].position.z = 2.5f;                // in the box: no background
  return s;
}

GraphRunOptions small() {
  GraphRunOptions options;
  options.size = {96, 80};
  options.frames = 8;
  options.set = {"vpl_count=320", "map_size=32", "shadow_map_size=512", "voxels=48"};
  return options;
}

std::function<void(scene::Frame&)> look(const std::string& view) {
  return [view](scene::Frame& frame) {
    frame.views[0] = *frame.findView(view);
    frame.views[0].name = "main";
  };
}

double meanSquaredError(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i)
    if (i % 4 != 3) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  return sum / (0.75 * double(a.size()));
}

double meanOf(const std::vector<float>& a) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i)
    if (i % 4 != 3) sum += a[i];
  return sum / (0.75 * double(a.size()));
}

TEST(Quad, EveryPictureIsAsGoodAsOneOfItsOwn) {
  const scene::Scene s = box();
  const GraphRun all = runGraph("foveal_quad", s, small());
  for (int i = 0; i < 4; ++i) {
    GraphRunOptions own = small(), exact = small();
    own.beforeFrame = exact.beforeFrame = look(kViews[i]);
    own.outputs = exact.outputs = {"radiance"};
    exact.set = {"spp=256"};
    exact.frames = 1;  // nothing moves
    const auto truth = toFloats(runGraph("reference", s, exact).outputs.at("radiance")),
               shared = toFloats(all.outputs.at(kOutputs[i]));
    const double error = meanSquaredError(shared, truth),
                 alone = meanSquaredError(toFloats(runGraph("foveal", s, own).outputs.at("radiance")), truth);
    std::printf("%s: mean squared error %.3g, of `foveal` %.3g, light %.3f\n", kViews[i], error, alone,
                meanOf(shared) / meanOf(truth));
    EXPECT_LT(error, 1.3 * alone) << kViews[i];
    EXPECT_NEAR(meanOf(shared) / meanOf(truth), 1, 0.05) << kViews[i];
  }
}

// Pictures of the right eye take the light of what the left one shows, and shade the rest.
TEST(Quad, TheRightEyeShadesWhatTheLeftOneDoesNotSee) {
  const GraphRun run = runGraph("foveal_quad", box(), small());
  const auto counter = [&](const std::string& name) {
    for (const auto& [n, value] : run.frames.back().counters)
      if (n == name) return value;
    ADD_FAILURE() << "no counter " << name;
    return 0.0;
  };
  for (const std::string part : {"right", "right-inset"}) {
    const double share = counter(part + "/reproject.new_pixels") / counter(part + "/reproject.pixels");
    EXPECT_GT(share, 0.01) << part;
    EXPECT_LT(share, 0.15) << part;
  }
}

TEST(Quad, RepeatsBitForBit) {
  const GraphRun a = runGraph("foveal_quad", box(), small()), b = runGraph("foveal_quad", box(), small());
  for (const char* name : kOutputs) EXPECT_EQ(a.outputs.at(name).bytes, b.outputs.at(name).bytes) << name;
}

}  // namespace
}  // namespace fovea::test
