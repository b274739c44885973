// Compares the path tracer's table of surfaces with the look-ups it was made from.
#include "passes/path-trace/surface_table.h"
#include "framework/scene/scene.h"

#include <gtest/gtest.h>

#include "framework/base/random.h"
#include "tests/support/shapes.h"

namespace fovea::path_trace {
namespace {

using namespace scene;

// Textures of odd sizes, wrapped in every way, and normals that are not those of the face.
Scene textured() {
  Scene s;
  uint32_t random = 1;
  for (int i = 0; i < 6; ++i) {
    Texture t;
    t.width = i == 2 ? 1 : 64 - 13 * uint32_t(i % 3);
    t.height = i == 3 ? 33 : 32;
    t.srgb = i % 2 == 0;
    for (uint32_t k = 0; k < 4 * t.width * t.height; ++k) t.rgba.push_back(uint8_t(random = hashPcg(random)));
    s.textures.push_back(t);
    Material& m = s.materials[test::addMaterial(s, glm::vec3(0.9f, 0.5f, 0.2f))];
    m.metallic = 0.1f * float(i);
    m.doubleSided = i % 2 == 1;
    m.baseColorTexture.texture = uint32_t(i);
    m.baseColorTexture.wrapU = Wrap(i % 3);
    m.baseColorTexture.wrapV = Wrap((i + 1) % 3);
    m.baseColorTexture.transform = {2.5f, 0.5f, -0.25f, 3, -1.5f, 0.25f};
    test::addQuad(s, uint32_t(i), glm::vec3(i, 0, 0), {1, 0, 0}, {0, 1, 0.5f});
    auto& normals = s.meshes.back().primitives[0].normals;
    for (size_t k = 0; k < normals.size(); ++k)
      normals[k] = glm::normalize(normals[k] + 0.3f * glm::vec3(float(k) - 1.5f, 0.5f, 0));
  }
  test::addQuad(s, test::addMaterial(s, glm::vec3(0.5f)), {9, 0, 0}, {1, 0, 0}, {0, 0, -1});  // no texture
  return s;
}

TEST(SurfaceTable, HoldsWhatTheSceneHolds) {
  const Scene s = textured();
  const Geometry g = flatten(s);
  Frame frame;
  frame.scene = &s;
  frame.geometry = &g;
  const SurfaceTable table(frame);
  for (uint32_t t = 0; t < g.triangles.size(); ++t)
    for (uint32_t k = 0; k < 200; ++k) {
      float u = uniformFloat(hashCombine(t, 2 * k)), v = uniformFloat(hashCombine(t, 2 * k + 1));
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const RayHit hit{t, 2, u, v};
      const SurfaceHit expected = surfaceAt(g, hit);
      const glm::vec3 direction(0.5f, -1, 0.25f);
      const SurfaceHit found = table.at({expected.position - 2.0f * direction, direction}, hit);
      EXPECT_LT(glm::distance(found.position, expected.position), 1e-5f);
      EXPECT_LT(glm::distance(found.geometricNormal, expected.geometricNormal), 1e-6f);
      EXPECT_LT(glm::distance(found.shadingNormal, expected.shadingNormal), 1e-4f);
      EXPECT_LT(glm::distance(found.uv, expected.uv), 1e-6f);
      ASSERT_EQ(found.material, expected.material);
      EXPECT_EQ(table.doubleSided(found.material), s.materials[found.material].doubleSided);
      TextureTaps taps;
      table.find(found.material, expected.uv, taps);
      const glm::vec3 rho(reflectance(s, s.materials[found.material], expected.uv));
      ASSERT_LT(glm::distance(table.reflectance(found.material, taps), rho), 1e-6f) << t << ' ' << k;
    }
}

}  // namespace
}  // namespace fovea::path_trace
