// Tests pass gbuffer with full materials against path_trace::Materials, at rays through the pixels' centres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "framework/base/random.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/materials.h"
#include "shaders/records/scene.h"
#include "tests/passes/full_materials_reference.h"
#include "tests/passes/ray_reference.h"
#include "tests/references/passage.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 72, kHeight = 54;

// Smooth, so that a hair's breadth at the edge of a texel makes no difference; normals lean by up to 30 degrees.
scene::Texture wavesTexture(bool srgb, bool normals) {
  scene::Texture t{"waves", 32, 32, srgb, {}};
  for (uint32_t y = 0; y < 32; ++y)
    for (uint32_t x = 0; x < 32; ++x) {
      const float phase = 2 * glm::pi<float>() / 32, a = std::sin(phase * float(x)),
                  b = std::cos(phase * float(y));
      const glm::vec3 c = normals ? 0.5f + 0.5f * glm::normalize(glm::vec3(0.5f * a, 0.5f * b, 1))
                                  : glm::vec3(0.6f + 0.35f * a, 0.6f + 0.35f * b, 0.5f + 0.3f * a * b);
      for (int k = 0; k < 3; ++k) t.rgba.push_back(uint8_t(std::lround(255 * c[k])));
      t.rgba.push_back(uint8_t(std::lround(255 * (0.7f + 0.2f * b))));
    }
  return t;
}

// Panels side by side that face the camera, and one with its back to it. Colours are textures 0, others texture 1,
// normals texture 2.
scene::Scene panels(const std::vector<scene::Material>& materials) {
  scene::Scene s;
  s.environment = {0.25f, 0.5f, 2};
  s.textures = {wavesTexture(true, false), wavesTexture(false, false), wavesTexture(false, true)};
  s.materials = materials;
  for (uint32_t m = 0; m < materials.size(); ++m) {
    const float x = -2 + 4 * float(m) / float(materials.size()), w = 3.7f / float(materials.size()),
                tilt = 0.4f * float(m % 3);
    if (m % 2 == 0)
      addQuad(s, m, {x, -1.4f, 0}, {x + w, -1.4f, -tilt}, {x + w, 1.4f, 0}, {x, 1.4f, tilt});
    else
      addQuad(s, m, {x, -1.4f, 0}, {x, 1.4f, tilt}, {x + w, 1.4f, 0}, {x + w, -1.4f, -tilt});
    s.materials[m].doubleSided = true;
    scene::Primitive& p = s.meshes.back().primitives[0];
    p.normals[0] = glm::normalize(p.normals[0] + glm::vec3(0.2f, 0.1f, 0));
  }
  s.cameras.emplace_back();
  s.cameras[0].position = {0.1f, 0.05f, 3.2f};
  s.cameras[0].verticalFov = 1;
  return s;
}

scene::TextureUse use(uint32_t texture, uint32_t set = 0) {
  scene::TextureUse u;
  u.texture = texture;
  u.transform = {1.3f, 0.2f, -0.2f, 0.9f, 0.1f, 0.3f};
  u.set = set;
  return u;
}

struct Difference {
  double normal = 0, albedo = 0, specular = 0, grazing = 0, metallic = 0, emission = 0;
};

// The largest differences from the CPU. What is seen at the outermost pixels of a panel may be another surface.
Difference compare(const scene::Scene& s, int& compared) {
  PassTest test("gbuffer");
  test.scene(s).viewSize(kWidth, kHeight).view("materials", "full");
  test.run();
  const auto normal = test.floats("gbuffer.normal"), albedo = test.floats("gbuffer.albedo"),
             specular = test.floats("gbuffer.specular"), emission = test.floats("gbuffer.emission");
  const auto id = test.values<uint32_t>("gbuffer.id");
  const scene::View& view = test.lastFrame().views[0];
  const scene::Geometry& g = test.geometry();
  const path_trace::Materials materials(s, g);
  Difference most;
  compared = 0;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const glm::dvec3 ray(view.rayDirection(glm::vec2(i % kWidth, i / kWidth) + 0.5f));
    const RayHit hit = castRay(s, g, glm::dvec3(view.eye), ray);
    if (!hit || id[i] != g.triangles[hit.triangle].materialAndObject) continue;
    ++compared;
    const path_trace::SurfacePoint p = materials.at({hit.triangle, float(hit.t), float(hit.u), float(hit.v)});
    const glm::vec3 out = glm::normalize(view.eye - p.position), n = p.normalTowards(out);
    const auto vec = [&](const std::vector<float>& v) {
      return glm::vec4(v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]);
    };
    const auto worse = [](double& most, double value) { most = std::max(most, value); };
    SurfacePixel want;
    setMaterial(want, p.bsdf, glm::dot(n, out));
    if (p.unlit) want.albedo = glm::vec3(0), want.specular = {0, 0, 0, 1}, want.grazing = want.metallic = 0;
    // What is seen of glass stands for the rays that have passed it.
    const scene::Material& m = s.materials[g.triangles[hit.triangle].material()];
    const scene::SurfaceHit at =
        scene::surfaceAt(g, {hit.triangle, float(hit.t), float(hit.u), float(hit.v)});
    const float brighter = 1 / (1 - scene::passage(s, m, at.uv, std::abs(glm::dot(at.shadingNormal, out))));
    want.albedo *= brighter;
    want.specular *= glm::vec4(glm::vec3(brighter), 1);
    want.grazing *= brighter;
    worse(most.normal, glm::length(glm::vec3(vec(normal)) - n));
    worse(most.albedo, glm::length(glm::vec3(vec(albedo)) - want.albedo));
    worse(most.specular, glm::length(vec(specular) - want.specular));
    // The sign marks transparent surfaces.
    worse(most.grazing,
          std::abs(vec(normal).w - (scene::letsLightThrough(m) ? -want.grazing : want.grazing)));
    worse(most.metallic, std::abs(vec(albedo).w - want.metallic));
    worse(most.emission, glm::length(glm::vec3(vec(emission)) - p.emission));
  }
  return most;
}

void expectNothing(const Difference& d) {
  EXPECT_LT(d.normal, 3e-3);  // half floats, and a slope of the texture between two texels
  EXPECT_LT(d.albedo, 3e-3);
  EXPECT_LT(d.specular, 3e-3);
  EXPECT_LT(d.grazing, 2e-3);
  EXPECT_LT(d.metallic, 2e-3);
  EXPECT_LT(d.emission, 3e-3);
}

TEST(GBufferFull, FactorsAreThoseOfTheMaterial) {
  std::vector<scene::Material> list(6);
  list[0].baseColor = {0.8f, 0.5f, 0.2f, 1};
  list[0].roughness = 0.3f;
  list[1].baseColor = {0.9f, 0.6f, 0.3f, 1};
  list[1].metallic = 1;
  list[1].roughness = 0.5f;
  list[2].metallic = 0.4f;
  list[2].specular = 0.5f;
  list[2].specularColor = {1, 0.5f, 2};
  list[3].transmission = 0.7f;
  list[3].roughness = 0.1f;
  list[4].unlit = true;
  list[4].baseColor = {0.3f, 0.5f, 0.7f, 1};
  list[4].emission = glm::vec3(9);
  list[5].emission = {1, 2, 3};
  list[5].baseColor = glm::vec4(0.5f);
  int compared;
  expectNothing(compare(panels(list), compared));
  EXPECT_GT(compared, 1800);  // a part of what glass covers shows the void
}

TEST(GBufferFull, TexturesAreThoseOfTheMaterial) {
  std::vector<scene::Material> list(6);
  for (scene::Material& m : list) {
    m.metallic = 0.8f;
    m.baseColorTexture = use(0);
    m.normalTexture = use(2);
  }
  list[0].metallicRoughnessTexture = use(1);
  list[1].normalScale = 0.6f;
  list[1].roughness = 0.2f;
  list[2].specularTexture = use(1);
  list[2].metallic = 0;
  list[3].specularColorTexture = use(0);
  list[3].specularColor = {2, 3, 4};
  list[3].metallic = 0.1f;
  list[4].transmission = 0.9f;
  list[4].transmissionTexture = use(1);
  list[4].metallic = 0;
  list[5].emission = {1, 2, 3};
  list[5].emissionTexture = use(0);
  int compared;
  expectNothing(compare(panels(list), compared));
  EXPECT_GT(compared, 1800);  // a part of what glass covers shows the void
}

TEST(GBufferFull, SecondTextureCoordinatesAndColoursOfVertices) {
  std::vector<scene::Material> list(2);
  list[0].metallicRoughnessTexture = use(1, 1);
  list[0].metallic = 1;
  list[1].baseColorTexture = use(0, 1);
  list[1].normalTexture = use(2, 1);
  scene::Scene s = panels(list);
  for (scene::Mesh& mesh : s.meshes) {
    mesh.primitives[0].secondUvs = {{0.3f, 0.1f}, {0.9f, 0.2f}, {1.1f, 1.3f}, {0.2f, 0.8f}};
    mesh.primitives[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0.5f, 0.5f, 1, 1}, {1, 1, 1, 1}};
  }
  int compared;
  expectNothing(compare(s, compared));
  EXPECT_GT(compared, 1500);
}

// A coat takes light from what is below it and joins its lobe.
TEST(GBufferFull, ACoatReflectsAndDims) {
  std::vector<scene::Material> list(2);
  for (scene::Material& m : list) m.baseColor = glm::vec4(0.8f, 0.4f, 0.2f, 1);
  list[1].clearcoat = 1;
  list[1].clearcoatRoughness = 0.1f;
  PassTest test("gbuffer");
  test.scene(panels(list)).viewSize(kWidth, kHeight).view("materials", "full");
  test.run();
  const auto albedo = test.floats("gbuffer.albedo"), specular = test.floats("gbuffer.specular");
  const size_t bare = 4 * (27 * kWidth + 22), coated = 4 * (27 * kWidth + 50);
  EXPECT_NEAR(albedo[coated] / albedo[bare], (1 - 0.045f) * (1 - 0.09f), 0.02f);
  EXPECT_NEAR(specular[coated], 0.04f * 0.87f + 0.04f, 0.003f);
  EXPECT_EQ(specular[bare + 3], 1);
  EXPECT_GT(specular[coated + 3], 0.3f);
  EXPECT_LT(specular[coated + 3], 0.8f);
}

TEST(GBufferFull, WithDiffuseMaterialsNothingIsAllocated) {
  PassTest test("gbuffer");
  test.scene(panels(std::vector<scene::Material>(2))).viewSize(kWidth, kHeight);
  test.run();
  EXPECT_EQ(test.desc("gbuffer.specular").width, 1u);
  EXPECT_EQ(test.desc("gbuffer.specular").height, 1u);
  EXPECT_EQ(test.floats("gbuffer.albedo")[4 * (27 * kWidth + 22) + 3], 0);
}

// A BLEND surface and a pane of glass in front of the background: pixel, frame and triangle determine which pixels show
// them.
TEST(GBufferFull, WhatLetsLightThroughIsSeenAtSomePixels) {
  std::vector<scene::Material> list(2);
  list[0].masked = list[0].blended = true;
  list[0].baseColor.a = 0.35f;
  list[1].transmission = 0.7f;
  scene::Scene s = panels(list);
  const auto idsOf = [&](uint32_t frames) {
    PassTest test("gbuffer");
    test.scene(s).viewSize(kWidth, kHeight).view("materials", "full");
    test.run(frames);
    return std::tuple(test.values<uint32_t>("gbuffer.id"), test.floats("gbuffer.normal"), test.lastFrame());
  };
  const auto [first, normals, frame] = idsOf(1);
  EXPECT_EQ(first, std::get<0>(idsOf(1)));
  EXPECT_NE(first, std::get<0>(idsOf(2)));
  scene::Scene solid = s;  // for rays that hit everything
  solid.materials[0].masked = false;
  const scene::Geometry g = scene::flatten(s);
  uint32_t pixels[2] = {}, shown[2] = {}, wrong = 0, unmarked = 0;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const glm::uvec2 pixel(i % kWidth, i / kWidth);
    const scene::View& view = frame.views[0];
    const glm::vec3 direction = view.rayDirection(glm::vec2(pixel) + 0.5f);
    const RayHit hit = castRay(solid, g, glm::dvec3(view.eye), glm::dvec3(direction));
    if (!hit) continue;
    const scene::SurfaceHit at =
        scene::surfaceAt(g, {hit.triangle, float(hit.t), float(hit.u), float(hit.v)});
    const scene::Material& m = s.materials[at.material];
    const float cosine = std::abs(glm::dot(at.shadingNormal, glm::normalize(direction)));
    const float stops = scene::coverage(s, m, at.uv) * (1 - scene::passage(s, m, at.uv, cosine));
    const uint32_t key = hashCombine(hashCombine(frame.seed, scene::kPassageStream), hit.triangle);
    const bool seen = first[i] != ~0u;
    wrong += seen != (stops > scene::passageChance(key, pixel, uint32_t(frame.index)));
    unmarked += !(normals[4 * i + 3] < 0);
    ++pixels[at.material];
    shown[at.material] += seen;
  }
  EXPECT_GT(std::min(pixels[0], pixels[1]), 500u);
  EXPECT_LE(wrong, (pixels[0] + pixels[1]) / 100);  // at the edges of panels, and by rounding
  EXPECT_LE(unmarked, (pixels[0] + pixels[1]) / 100);
  EXPECT_FALSE(normals[3] < 0);  // the void beside them
  EXPECT_NEAR(double(shown[0]) / pixels[0], 0.35, 0.06);
  EXPECT_NEAR(double(shown[1]) / pixels[1], 0.34, 0.06);

  // Diffuse materials treat BLEND as a mask, and glass as opaque.
  PassTest diffuse("gbuffer");
  diffuse.scene(s).viewSize(kWidth, kHeight);
  diffuse.run();
  const auto ids = diffuse.values<uint32_t>("gbuffer.id");
  EXPECT_TRUE(std::ranges::none_of(ids, [](uint32_t id) { return id != ~0u && (id & 0xffff) == 0; }));
  EXPECT_GT(std::ranges::count_if(ids, [](uint32_t id) { return id != ~0u && (id & 0xffff) == 1; }),
            pixels[1] / 2);
}

// What is BLEND and hides all that is behind it shows the same surface in every frame, and is not marked.
TEST(GBufferFull, WhatIsSolidIsNotMarked) {
  std::vector<scene::Material> list(2);
  for (scene::Material& m : list) m.masked = m.blended = true;
  list[1].baseColor.a = 0.5f;
  PassTest test("gbuffer");
  test.scene(panels(list)).viewSize(kWidth, kHeight).view("materials", "full");
  test.run();
  const auto ids = test.values<uint32_t>("gbuffer.id");
  const auto normals = test.floats("gbuffer.normal");
  uint32_t shown[2] = {}, marked[2] = {};
  for (size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == ~0u) continue;
    ++shown[ids[i] & 0xffff];
    marked[ids[i] & 0xffff] += normals[4 * i + 3] < 0;
  }
  EXPECT_GT(std::min(shown[0], shown[1]), 200u);
  EXPECT_EQ(marked[0], 0u);
  EXPECT_EQ(marked[1], shown[1]);

  for (scene::Material& m : list) m.baseColor.a = 0;  // nothing is there
  PassTest clear("gbuffer");
  clear.scene(panels(list)).viewSize(kWidth, kHeight).view("materials", "full");
  clear.run();
  const auto nothing = clear.floats("gbuffer.normal");
  for (size_t i = 0; i < ids.size(); ++i) EXPECT_FALSE(nothing[4 * i + 3] < 0) << i;
}

}  // namespace
}  // namespace fovea::test
