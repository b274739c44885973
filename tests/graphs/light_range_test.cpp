// Tests that pictures do not depend on the unit of light: if all light of a scene is multiplied by a factor and its
// exposure divided by it, every graph makes the same picture, from moonlight to far beyond the sun.
#include <gtest/gtest.h>

#include <cmath>

#include "framework/scene/lights.h"
#include "tests/graphs/corner.h"

namespace fovea::test {
namespace {

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

class LightRange : public testing::TestWithParam<std::string> {};

// Powers of two change no mantissa, so pictures are equal to the bit; other factors round.
TEST_P(LightRange, PicturesDoNotDependOnTheUnitOfLight) {
  const std::vector<float> plain =
      toFloats(renderCorner(GetParam(), cornerInTheOpen()).outputs.at("radiance"));
  double light = 0;
  for (size_t i = 0; i < plain.size(); i += 4) light += double(plain[i + 1]) / (kSide * kSide);
  ASSERT_GT(light, 0.1);
  const auto pictureAt = [&](float factor) {
    const GraphRun run = renderCorner(GetParam(), brighter(cornerInTheOpen(), factor));
    std::vector<float> values = toFloats(run.outputs.at("radiance"));
    for (float& v : values) v /= factor;
    return values;
  };
  for (const int stops : {-27, 27}) {  // 1e-8 and 1e8
    const std::vector<float> scaled = pictureAt(std::exp2(float(stops)));
    size_t different = 0;
    for (size_t i = 0; i < plain.size(); ++i) different += i % 4 != 3 && scaled[i] != plain[i];
    EXPECT_EQ(different, 0) << "of " << plain.size() << " values, with light times 2^" << stops;
  }
  for (const float factor : {1e-8f, 683000.0f / 3, 1e8f})
    EXPECT_LT(relativeError(pictureAt(factor), plain), 1e-3) << "light times " << factor;
}

INSTANTIATE_TEST_SUITE_P(Graphs, LightRange, testing::ValuesIn(kGraphs), nameOfGraph);
INSTANTIATE_TEST_SUITE_P(LongGraphs, LightRange, testing::ValuesIn(otherGraphs()), nameOfGraph);

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
  EXPECT_EQ(renderCorner("direct", s).outputs.at("radiance").beyondRange, kSide * kSide);
  EXPECT_EQ(renderCorner("reference", s).outputs.at("radiance").beyondRange, 0);  // it stores 32-bit floats
  s.exposure = 1e-3f;
  EXPECT_EQ(renderCorner("direct", s).outputs.at("radiance").beyondRange, 0);
  EXPECT_NEAR(toFloats(renderCorner("direct", s).outputs.at("radiance"))[0], 1e6f, 1e3f);
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
      const std::vector<float> image = toFloats(renderCorner(graph, s).outputs.at("radiance"));
      EXPECT_NEAR(image[0], 0.25f, 1e-3f) << graph << " at exposure " << exposure;
      EXPECT_NEAR(image[1], 0.5f, 1e-3f) << graph << " at exposure " << exposure;
    }
  }
}

}  // namespace
}  // namespace fovea::test
