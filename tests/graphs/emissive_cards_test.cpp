// Tests that emissive surfaces light others where, and as far as, they are seen: not in the holes of alpha masks, and with
// alphaMode BLEND by their alpha. In a furnace, a closed room whose black walls emit the same radiance everywhere, a black
// card with that radiance cannot be told from what is behind it whatever its alpha. So cards must change nothing.
#include <gtest/gtest.h>

#include "tests/graphs/corner.h"

namespace fovea::test {
namespace {

constexpr uint32_t kTexels = 8;

// White texels, whose alpha is that of `alphaAt`.
template <class Alpha>
scene::TextureUse addAlpha(scene::Scene& s, const Alpha& alphaAt) {
  scene::Texture t{"alpha", kTexels, kTexels, true, {}};
  for (uint32_t i = 0; i < kTexels * kTexels; ++i)
    t.rgba.insert(t.rgba.end(), {255, 255, 255, alphaAt(i % kTexels, i / kTexels)});
  s.textures.push_back(std::move(t));
  return {.texture = uint32_t(s.textures.size() - 1)};
}

uint32_t addGlow(scene::Scene& s, float alpha) {
  const uint32_t index = addMaterial(s, glm::vec3(0));
  scene::Material& m = s.materials[index];
  m.baseColor.a = alpha;
  m.emission = glm::vec3(1);
  m.ior = 1;
  return index;
}

// A grey square in a furnace, and around the line of sight to it five cards that face it. All is far enough apart that
// the VPLs' clamp does not matter.
scene::Scene furnace(bool fullMaterials, bool cards) {
  scene::Scene s;
  s.materials.clear();
  s.fullMaterials = fullMaterials;
  const uint32_t wall = addGlow(s, 1), walls[6] = {wall, wall, wall, wall, wall, wall};
  addRoom(s, walls, 8);
  const uint32_t grey = addMaterial(s, glm::vec3(0.6f));
  s.materials[grey].ior = 1;
  addQuad(s, grey, {-2.8f, -2.8f, -4}, {5.6f, 0, 0}, {0, 5.6f, 0});
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 0, 7};
  s.cameras[0].verticalFov = 0.3f;
  if (!cards) return s;

  const auto add = [&](float alpha, float x, float y) {
    addQuad(s, addGlow(s, alpha), {x, y, -1}, {0, 4, 0}, {4, 0, 0});
    s.materials.back().masked = true;
    return &s.materials.back();
  };
  add(0.3f, -6.8f, -2)->blended = true;
  add(0.8f, 2.8f, -2)->blended = true;
  add(1, -2, 2.8f)->baseColorTexture =
      addAlpha(s, [](uint32_t x, uint32_t y) { return uint8_t((x + y) % 2 == 0 ? 255 : 0); });
  scene::Material* faded = add(1, -2, -6.8f);
  faded->blended = true;
  faded->baseColorTexture = addAlpha(s, [](uint32_t x, uint32_t) { return uint8_t(36 * x); });
  add(1, 2.8f, 2.8f);
  s.meshes.back().primitives[0].colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
  return s;
}

class EmissiveCards : public testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(EmissiveCards, CannotBeToldFromTheWallsOfAFurnace) {
  const std::string graph = std::get<0>(GetParam());
  const bool fullMaterials = std::get<1>(GetParam());
  const auto light = [&](bool cards) {
    GraphRunOptions options;
    options.size = {kSide, kSide};
    options.frames = 2;
    options.outputs = {"radiance"};
    if (graph == "reference") options.set = {"spp=64"};
    const GraphRun run = runGraph(graph, furnace(fullMaterials, cards), options);
    const std::vector<float> picture = toFloats(run.outputs.at("radiance"));
    double sum = 0;
    for (size_t i = 0; i < picture.size(); ++i) sum += double(picture[i]);
    return sum / (kSide * kSide) - 1;
  };
  const double coarse = graph == "ir_1000" ? 0.04 : 0.01;  // few VPLs are on the cards
  EXPECT_NEAR(light(true) / light(false), 1, coarse);
}

INSTANTIATE_TEST_SUITE_P(Graphs, EmissiveCards,
                         testing::Combine(testing::Values("reference", "ir_1000", "foveal",
                                                          "alternatives/restir_gi"),
                                          testing::Bool()),
                         [](const auto& info) {
                           std::string name =
                               std::get<0>(info.param) + (std::get<1>(info.param) ? "_full" : "");
                           std::ranges::replace(name, '/', '_');
                           return name;
                         });

}  // namespace
}  // namespace fovea::test
