// Tests that pictures do not depend on the unit of light: if all light of a scene is multiplied by a factor and its
// exposure divided by it, every graph makes the same picture, from moonlight to far beyond the sun.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/lights.h"
#include "tests/support/graph_run.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSide = 40;

// A corner under a sky, with a sun, a lamp, a spot light, and emissive and unlit surfaces.
scene::Scene cornerInTheOpen() {
  scene::Scene s;
  s.fullMaterials = true;
  addQuad(s, addMaterial(s, {0.6f, 0.5f, 0.4f}), {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  addQuad(s, addMaterial(s, {0.3f, 0.6f, 0.3f}), {-4, 0, -1}, {8, 0, 0}, {0, 3, 0});
  const uint32_t panel = addMaterial(s, glm::vec3(0.2f));
  s.materials[panel].emission = {2, 1.5f, 1};
  addQuad(s, panel, {-1.5f, 0.4f, -0.99f}, {0.8f, 0, 0}, {0, 0.8f, 0});
  std::vector<glm::vec3> texels(16 * 8, glm::vec3(0.3f, 0.4f, 0.6f));
  s.environmentMap = std::make_shared<scene::EnvironmentMap>(16, 8, texels);
  s.lights.resize(3);
  s.lights[0].direction = glm::normalize(glm::vec3(0.4f, -1, -0.5f));
  s.lights[0].intensity = 2;
  s.lights[1].type = scene::LightType::Point;
  s.lights[1].position = {1.5f, 1, 0.5f};
  s.lights[2].type = scene::LightType::Spot;
  s.lights[2].position = {-1, 2, 1};
  s.lights[2].direction = {0, -1, 0};
  s.lights[2].intensity = 3;
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 1.5f, 4};
  s.cameras[0].orientation = glm::angleAxis(glm::radians(-12.0f), glm::vec3(1, 0, 0));
  s.exposure = 0.4f;
  return s;
}

scene::Scene brighter(scene::Scene s, float factor) {
  for (scene::Light& light : s.lights) light.intensity *= factor;
  for (scene::Material& m : s.materials) m.emission *= factor;
  std::vector<glm::vec3> texels = s.environmentMap->texels();
  for (glm::vec3& t : texels) t *= factor;
  s.environmentMap =
      std::make_shared<scene::EnvironmentMap>(s.environmentMap->width(), s.environmentMap->height(), texels);
  s.exposure /= factor;
  return s;
}

GraphRun render(const char* graph, const scene::Scene& s) {
  GraphRunOptions options;
  options.size = {kSide, kSide};
  options.frames = 3;
  options.set = {"vpl_count=100", "map_size=32", "shadow_map_size=128", "voxels=32", "spp=8"};
  const std::string name = graph;
  std::erase_if(options.set, [&](const std::string& set) {
    const bool vpls = name != "direct" && name != "reference" && !name.starts_with("alternatives/");
    if (set.starts_with("spp")) return name != "reference";
    if (set.starts_with("shadow")) return name == "reference";
    if (set.starts_with("voxels")) return name == "ir_1000" || (!vpls && name != "alternatives/vxgi");
    return !vpls;
  });
  options.outputs = {"radiance"};
  return runGraph(graph, s, options);
}

class LightRange : public testing::TestWithParam<const char*> {};

// Powers of two change no mantissa, so pictures are equal to the bit.
TEST_P(LightRange, PicturesDoNotDependOnTheUnitOfLight) {
  const std::vector<float> plain = toFloats(render(GetParam(), cornerInTheOpen()).outputs.at("radiance"));
  double light = 0;
  for (size_t i = 0; i < plain.size(); i += 4) light += double(plain[i + 1]) / (kSide * kSide);
  ASSERT_GT(light, 0.1);
  for (const int stops : {-27, 27}) {
    const float factor = std::exp2(float(stops));
    const GraphRun run = render(GetParam(), brighter(cornerInTheOpen(), factor));
    const std::vector<float> scaled = toFloats(run.outputs.at("radiance"));
    size_t different = 0;
    for (size_t i = 0; i < plain.size(); ++i) different += i % 4 != 3 && scaled[i] != factor * plain[i];
    EXPECT_EQ(different, 0) << "of " << plain.size() << " values, with light times 2^" << stops;
  }
}

// Other factors round.
TEST_P(LightRange, PicturesHardlyDependOnOtherFactors) {
  const std::vector<float> plain = toFloats(render(GetParam(), cornerInTheOpen()).outputs.at("radiance"));
  for (const float factor : {1e-8f, 683000.0f / 3, 1e8f}) {
    const GraphRun run = render(GetParam(), brighter(cornerInTheOpen(), factor));
    const std::vector<float> scaled = toFloats(run.outputs.at("radiance"));
    double error = 0;
    for (size_t i = 0; i < plain.size(); ++i)
      if (i % 4 != 3)
        error += std::pow(double(scaled[i] / factor - plain[i]), 2) / (std::pow(double(plain[i]), 2) + 0.01);
    EXPECT_LT(error / (3 * kSide * kSide), 1e-3) << "light times " << factor;
  }
}

INSTANTIATE_TEST_SUITE_P(Graphs, LightRange,
                         testing::Values("direct", "ir_1000", "ours", "foveal", "foveal_stereo", "reference",
                                         "alternatives/ddgi", "alternatives/vxgi", "alternatives/restir_gi"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

// What passes store is the scene's light times a power of two, whatever its exposure.
TEST(PreExposure, IsThePowerOfTwoNearestToTheExposure) {
  scene::Scene s;
  EXPECT_EQ(scene::preExposure(s), 1);
  s.exposure = 0.4f;
  EXPECT_EQ(scene::preExposure(s), 0.5f);
  s.exposure = 1e-9f;
  EXPECT_EQ(scene::preExposure(s), std::exp2(-30.0f));
  s.preExposure = 3;
  EXPECT_EQ(scene::preExposure(s), 3);
}

// What does not fit is counted, and is not told to be less than it is.
TEST(PreExposure, CountsLightThatIsTooBrightToBeStored) {
  scene::Scene s;
  const uint32_t lamp = addMaterial(s, glm::vec3(0));
  s.materials[lamp].emission = {1e6f, 1, 1};
  addQuad(s, lamp, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0});
  s.cameras.emplace_back();
  EXPECT_EQ(render("direct", s).outputs.at("radiance").beyondRange, kSide * kSide);
  EXPECT_EQ(render("reference", s).outputs.at("radiance").beyondRange, 0);  // it stores 32-bit floats
  s.exposure = 1e-3f;
  EXPECT_EQ(render("direct", s).outputs.at("radiance").beyondRange, 0);
  EXPECT_NEAR(toFloats(render("direct", s).outputs.at("radiance"))[0], 1e6f, 1e3f);
}

// Unlit surfaces show their base colour whatever the exposure is.
TEST(PreExposure, LeavesUnlitSurfacesAsTheyAre) {
  scene::Scene s;
  s.fullMaterials = true;
  const uint32_t paper = addMaterial(s, {0.25f, 0.5f, 0.75f});
  s.materials[paper].unlit = true;
  addQuad(s, paper, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0});
  s.cameras.emplace_back();
  for (const float exposure : {1e-6f, 1.0f, 1e4f}) {
    s.exposure = exposure;
    for (const char* graph : {"direct", "reference"}) {
      const std::vector<float> image = toFloats(render(graph, s).outputs.at("radiance"));
      EXPECT_NEAR(image[0], 0.25f, 1e-3f) << graph << " at exposure " << exposure;
      EXPECT_NEAR(image[1], 0.5f, 1e-3f) << graph << " at exposure " << exposure;
    }
  }
}

}  // namespace
}  // namespace fovea::test
