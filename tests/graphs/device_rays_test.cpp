// Rays that are traced on the device give the same pictures as those on the host.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fovea/scene.h"
#include "framework/scene/load.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

// The moving Cornell box with a cube that has holes or, with full materials, is transparent, and a ring of glass.
scene::Scene movingScene() {
  Diagnostics warnings;
  scene::Scene scene = scene::load("cornellbox_moving", warnings);
  for (scene::Material& material : scene.materials) {
    if (material.name == "yellow") material.masked = material.blended = true, material.baseColor.a = 0.6f;
    if (material.name == "blue") material.transmission = 0.7f;
  }
  return scene;
}

class DeviceRaysInGraphs : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Materials, DeviceRaysInGraphs, testing::Values("diffuse"));
INSTANTIATE_TEST_SUITE_P(LongMaterials, DeviceRaysInGraphs, testing::Values("full"));

int countDifferent(const graph::OutputData& wanted, const graph::OutputData& given) {
  const std::vector<float> want = toFloats(wanted), got = toFloats(given);
  EXPECT_EQ(want.size(), got.size());
  int different = 0;
  for (size_t i = 0; i < want.size(); ++i)
    different += !(std::abs(want[i] - got[i]) <= 5e-3f * std::max(std::abs(want[i]), 0.02f));
  return different;
}

double meanOf(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += double(v) / double(values.size());
  return sum;
}
double meanDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i]) - double(b[i])) / double(a.size());
  return sum;
}

// Rounding decides which surface a path meets that just grazes an edge, and which rays pass glass; one VPL that differs
// changes which others are kept. Pictures may therefore differ as if they had other random numbers, but no more.
TEST_P(DeviceRaysInGraphs, GiveThePicturesOfTheHost) {
  const scene::Scene scene = movingScene();
  const auto render = [&](const char* name, session::RaysOn rays, uint32_t seed = 1) {
    return runGraph(name, scene,
                    {.size = {96, 72},
                     .frames = 4,
                     .seed = seed,
                     .set = {std::string("view.materials=") + GetParam(), "vpl_count=200"},
                     .rays = rays});
  };
  using session::RaysOn;
  const GraphRun host = render("foveal", RaysOn::Host), device = render("foveal", RaysOn::Device),
                 maps = render("foveal_no_shadow_rays", RaysOn::Host),
                 other = render("foveal", RaysOn::Host, 2);
  const int byRays = countDifferent(maps.outputs.at("direct"), host.outputs.at("direct"));
  EXPECT_GT(byRays, 20);
  EXPECT_LE(countDifferent(host.outputs.at("direct"), device.outputs.at("direct")), byRays / 4);
  const std::vector<float> want = toFloats(host.outputs.at("radiance")),
                           got = toFloats(device.outputs.at("radiance")),
                           otherwise = toFloats(other.outputs.at("radiance"));
  EXPECT_NEAR(meanOf(got), meanOf(want), 0.005 * meanOf(want));
  EXPECT_LT(meanDifference(got, want), meanDifference(otherwise, want));
}

}  // namespace
}  // namespace fovea::test
