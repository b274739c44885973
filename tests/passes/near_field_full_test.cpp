// Compares near-field light from full materials with their BSDF.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "framework/base/random.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/microfacets.h"
#include "tests/passes/full_materials_reference.h"
#include "tests/passes/near_field_run.h"
#include "tests/passes/vpl_intensity_reference.h"

namespace fovea::test {
namespace {

// Irradiance / pi at a pixel from what surfaces of one material reflect of a lamp, without shadows.
glm::dvec3 mirroredBy(const Room& room, const scene::Light& lamp, const Seen& seen, uint32_t material) {
  constexpr int kRays = 8000;
  const scene::Material& m = room.scene.materials[material];
  const path_trace::BsdfParameters parameters =
      bsdfParameters(glm::vec3(m.baseColor), m.metallic, m.roughness);
  glm::dvec3 sum(0);
  for (int i = 0; i < kRays; ++i) {
    const glm::vec2 u((float(i) + 0.5f) / float(kRays), uniformFloat(uint32_t(i) * 2654435769u));
    const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y;
    const glm::vec3 d = path_trace::toWorld(path_trace::frameAround(seen.normal),
                                            {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x)});
    const RayHit hit = castRay(room.scene, room.geometry,
                               glm::dvec3(seen.position) + 1e-5 * glm::dvec3(seen.normal), glm::dvec3(d));
    if (!hit || room.geometry.triangles[hit.triangle].material() != material) continue;
    const glm::vec3 at = seen.position + float(hit.t) * d, to = lamp.position - at, normal(1, 0, 0);
    const glm::mat3 axes = path_trace::frameAround(normal);
    const path_trace::Bsdf bsdf(parameters, path_trace::toLocal(axes, -d));
    sum += glm::dvec3(lamp.color * lamp.intensity *
                      bsdf.evaluate(path_trace::toLocal(axes, glm::normalize(to)))) /
           double(glm::dot(to, to));
  }
  return sum / double(kRays);
}

// With full materials light comes from where surfaces send it: a polished metal wall beside the floor sends a lamp's
// light towards some of the floor, and little to where the lamp hangs.
TEST(NearFieldFull, MetalSendsLightInItsLobe) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), metal = addMaterial(s, glm::vec3(0.9f));
  s.materials[metal].metallic = 1;
  s.materials[metal].roughness = 0.4f;
  addQuad(s, grey, {-2, -1, -4}, {0, 0, 4}, {4, 0, 0});
  addQuad(s, metal, {-2, -1, -4}, {0, 0, 8}, {0, 4, 0});
  s.materials[metal].doubleSided = true;
  s.lights = {pointLight({0.5f, 2, -2}, glm::vec3(10))};
  const Room room = lookInto(std::move(s), 8, glm::ivec2(8));
  NearFieldTest test(room.scene, glm::uvec2(8));
  test.view("materials", "full").param("bounces", 1);
  test.param("vpls", 1).param("share", 1e6);  // nothing is left to discs
  const std::vector<glm::vec4> got = NearFieldMeans(test, 256).samples;
  int lit = 0;
  for (uint32_t i = 0; i < 16; ++i) {
    glm::dvec3 want(0);
    bool same = true;
    for (uint32_t k = 0; k < 4; ++k) {
      const Seen seen = room.pixels[(2 * (i / 4) + k / 2) * 8 + 2 * (i % 4) + k % 2];
      same = same && seen.normal.y > 0.9f;
      want += mirroredBy(room, room.scene.lights[0], seen, metal) / 4.0;
    }
    if (!same || got[i].a == 0) continue;
    ++lit;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[i][c], want[c], 0.04 * want[c]) << i;
  }
  EXPECT_GT(lit, 3);
}

// The contribution of an emissive lamp to the mean under the lobe of each pixel: the integral of the microfacets'
// reflection of it. A floor that is seen at a grazing angle has its highlight towards the wall behind.
TEST(NearFieldFull, LampsShineUnderLobes) {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f)), lamp = addMaterial(s, glm::vec3(0.0f));
  s.materials[lamp].emission = {4, 2, 1};
  addQuad(s, grey, {-3, -1, -6}, {0, 0, 6}, {6, 0, 0});
  addQuad(s, lamp, {-1, 0.2f, -6}, {2, 0, 0}, {0, 1, 0});
  const Room room = lookInto(std::move(s), 8, glm::ivec2(8));
  const scene::View view = scene::makeView(room.scene.cameras[0], glm::uvec2(8), room.geometry);
  for (const float roughness : {0.4f, 0.6f, 0.9f}) {
    const auto half = [](glm::vec4 v) { return glm::packHalf4x16(v); };
    const std::vector<uint64_t> normal(64, half({0, 1, 0, 1})),
        specular(64, half({0.001f, 0.001f, 0.001f, roughness}));
    NearFieldTest test(room.scene, glm::uvec2(8));
    test.view("materials", "full")
        .param("vpls", 1 << 20)
        .param("share", 0.01);  // nothing is left but the lamp
    test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, normal);
    test.image("gbuffer.specular", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, specular);
    const NearFieldMeans means(test, 128);
    const std::vector<glm::vec4>&diffuse = means.samples, &gloss = means.gloss;
    int lit = 0;
    double highest = 0;
    for (uint32_t i = 0; i < 16; ++i) {
      glm::dvec3 want(0), wantDiffuse(0);
      bool floor = true;
      for (uint32_t k = 0; k < 4; ++k) {
        const Seen seen = room.pixels[(2 * (i / 4) + k / 2) * 8 + 2 * (i % 4) + k % 2];
        floor = floor && seen.there && seen.normal.y > 0.9f;
        if (!floor) break;
        const glm::vec3 v = glm::normalize(view.eye - seen.position);
        const float alpha = path_trace::ggxWidth(roughness);
        const double albedo = double(path_trace::AlbedoTable::schlick().at(v.y, roughness).ofMirror());
        constexpr int kSide = 40;
        for (int c = 0; c < kSide * kSide; ++c) {
          const glm::vec3 at(-1 + 2 * (float(c % kSide) + 0.5f) / kSide,
                             0.2f + (float(c / kSide) + 0.5f) / kSide, -6);
          const glm::vec3 to = at - seen.position, l = glm::normalize(to), h = glm::normalize(l + v);
          const auto turned = [](glm::vec3 d) { return glm::vec3(d.x, d.z, d.y); };  // the normal becomes z
          const double arrives = double(l.y * l.z * -1 / glm::dot(to, to)) * 2 / (kSide * kSide) / 4;
          wantDiffuse += glm::dvec3(4, 2, 1) * arrives / glm::pi<double>();
          want += glm::dvec3(4, 2, 1) * arrives *
                  double(path_trace::mirrorBrdf(turned(l), turned(v), turned(h), alpha)) / albedo;
        }
      }
      if (!floor || gloss[i].a == 0) continue;
      ++lit;
      EXPECT_EQ(gloss[i].a, diffuse[i].a);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(diffuse[i][c], wantDiffuse[c], 0.03 * wantDiffuse[c]) << roughness << " " << i;
        EXPECT_NEAR(gloss[i][c], want[c], 0.04 * want[c]) << roughness << " " << i;
      }
      highest = std::max(highest, want.r / wantDiffuse.r);
    }
    EXPECT_GT(lit, 3);
    EXPECT_GT(highest, roughness < 0.5f ? 3 : 1.2) << "the highlight is in the picture";
  }
}

}  // namespace
}  // namespace fovea::test
