// Tests that shaders which count their operations render the same frames.
#include <gtest/gtest.h>

#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

TEST(CountingGraph, RendersTheSame) {
  Diagnostics messages;
  const scene::Scene scene = scene::load("cornellbox", messages);
  GraphRunOptions options{.size = {48, 48}, .set = {"vpl_count=16", "map_size=16"}, .outputs = {"radiance"}};
  const GraphRun plain = runGraph("ir_1000", scene, options);
  options.countOperations = true;
  const GraphRun counting = runGraph("ir_1000", scene, options);
  const std::vector<float> expected = toFloats(plain.outputs.at("radiance")),
                           found = toFloats(counting.outputs.at("radiance"));
  ASSERT_EQ(found.size(), expected.size());
  size_t different = 0;  // where rounding decides on what is seen
  for (size_t i = 0; i < found.size(); ++i)
    if (std::abs(found[i] - expected[i]) > 0.01f * std::abs(expected[i]) + 1e-4f) ++different;
  EXPECT_LT(different, found.size() / 100);
  EXPECT_EQ(counting.frames[0].counters, plain.frames[0].counters);
  for (size_t p = 0; p < plain.frames[0].passes.size(); ++p) {
    EXPECT_EQ(plain.frames[0].passes[p].operations, 0u);
    EXPECT_GT(counting.frames[0].passes[p].operations, 0u);
    EXPECT_EQ(counting.frames[0].passes[p].commands, plain.frames[0].passes[p].commands);
  }
}

}  // namespace
}  // namespace fovea::test
