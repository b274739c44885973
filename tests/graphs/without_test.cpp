// Whole graphs on a device without some features: their replacements give the same pictures, to the bit.
#include <gtest/gtest.h>
#include <vulkan/vulkan_core.h>

#include <memory>
#include <string>
#include <vector>

#include "fovea/scene.h"
#include "framework/base/paths.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "framework/session/test_device.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

// The moving Cornell box with all that is drawn in ways of its own: a cube that lets through half of the rays, a ring
// of coloured glass, and a point light, which has six layers, beside the spot light.
scene::Scene sceneToDraw() {
  Diagnostics warnings;
  scene::Scene scene = scene::load("cornellbox_moving", warnings);
  scene::Light point;
  point.type = scene::LightType::Point;
  point.position = {-1.5f, 3.5f, 1};
  point.intensity = 10;
  scene.lights.push_back(point);
  for (scene::Material& material : scene.materials) {
    if (material.name == "yellow") material.masked = material.blended = true, material.baseColor.a = 0.5f;
    if (material.name == "blue") material.transmission = 0.7f;
  }
  return scene;
}

GraphRun render(const char* graph, const scene::Scene& scene, gpu::Device& device,
                std::vector<std::string> set, session::RaysOn rays) {
  return runGraph(graph, scene,
                  {.size = {48, 40}, .frames = 2, .set = std::move(set), .device = &device, .rays = rays});
}

std::unique_ptr<gpu::Device> deviceWithout(const std::vector<std::string>& features) {
  gpu::DeviceOptions options = testDeviceOptions();
  options.without = features;
  auto device = std::make_unique<gpu::Device>(options);
  for (const auto& folder : shaderFolders()) device->shaders().addSearchPath(folder);
  return device;
}

// Draws with a device that has all features but ray queries, which round differently, and with one for each list of
// features that it does without.
void expectTheSame(const char* graph, const std::vector<std::string>& set, session::RaysOn rays,
                   const std::vector<std::vector<std::string>>& without) {
  const scene::Scene scene = sceneToDraw();
  const auto whole = deviceWithout({VK_KHR_RAY_QUERY_EXTENSION_NAME});
  const GraphRun expected = render(graph, scene, *whole, set, rays);
  for (const std::vector<std::string>& features : without) {
    SCOPED_TRACE("without " + features.front());
    const auto device = deviceWithout(features);
    const GraphRun run = render(graph, scene, *device, set, rays);
    for (const auto& [name, output] : expected.outputs)
      EXPECT_EQ(run.outputs.at(name).bytes, output.bytes) << graph << ", output " << name;
    EXPECT_EQ(device->validationMessages(), std::vector<std::string>{});
  }
}

TEST(Without, EachFeatureDirectLightIsTheSame) {
  std::vector<std::vector<std::string>> each;
  for (const std::string& feature : gpu::dispensableFeatures()) each.push_back({feature});
  expectTheSame("direct", {"view.materials=full"}, session::RaysOn::Auto, each);
}
TEST(Without, AllFeaturesPicturesAreTheSame) {
  expectTheSame("foveal", {"vpl_count=32"}, session::RaysOn::Host, {gpu::dispensableFeatures()});
}
TEST(LongWithout, AllFeaturesPicturesWithRaysOnTheDeviceAreTheSame) {
  expectTheSame("foveal", {"vpl_count=32"}, session::RaysOn::Device, {gpu::dispensableFeatures()});
}

}  // namespace
}  // namespace fovea::test
