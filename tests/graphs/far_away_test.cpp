// Tests that pictures do not depend on where a scene lies: at UTM coordinates, or 10,000 km from the origin, every graph
// makes the same picture as at the origin.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/scene/export/gltf.h"
#include "framework/scene/load.h"
#include "tests/graphs/corner.h"
#include "tests/unit/scene_support.h"

namespace fovea::test {
namespace {

class FarAway : public testing::TestWithParam<std::string> {};

TEST_P(FarAway, PicturesAreThoseAtTheOrigin) {
  const TemporaryFolder folder;
  Diagnostics warnings;
  scene::Scene corner = cornerInTheOpen();
  corner.name = "corner";
  corner.environmentMap = nullptr;  // which has no place
  scene::exportGltf(corner, folder.path(), warnings);
  const auto pictureAt = [&](glm::dvec3 place) {
    const std::string text = fmt::format(
        R"({{"models": [{{"file": "corner.gltf", "translate": [{}, {}, {}]}}], "exposure": 0.4}})", place.x,
        place.y, place.z);
    const scene::Scene scene = scene::load(folder.write("scene.json", text).string(), warnings);
    EXPECT_LT(glm::distance(scene.origin, place), 20);
    return toFloats(renderCorner(GetParam(), scene).outputs.at("radiance"));
  };
  const std::vector<float> here = pictureAt({});
  ASSERT_GT(relativeError(std::vector<float>(here.size(), 0), here), 0.1);  // it shows something
  // At the first place, coordinates relative to the scene's origin are the same as here. At the others they are rounded
  // differently in their last bits, and a few VPLs are chosen differently for that reason.
  const auto errorAt = [&](glm::dvec3 place) { return relativeError(pictureAt(place), here); };
  EXPECT_EQ(errorAt({1e7, 0, 1e7}), 0);
  EXPECT_LT(errorAt({1e7, -1e7, 1e7}), 1e-3);
  EXPECT_LT(errorAt({54000.1, 0, 0}), 1e-3);
  EXPECT_LT(errorAt({448262.125, 12.5, -5411932.25}), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Graphs, FarAway, testing::Values("direct", "foveal"), nameOfGraph);
INSTANTIATE_TEST_SUITE_P(LongGraphs, FarAway,
                         testing::Values("ir_1000", "ours", "reference", "foveal_stereo", "alternatives/ddgi",
                                         "alternatives/vxgi", "alternatives/restir_gi"),
                         nameOfGraph);
INSTANTIATE_TEST_SUITE_P(LongOtherGraphs, FarAway, testing::ValuesIn(otherGraphs()), nameOfGraph);

}  // namespace
}  // namespace fovea::test
