// Tests path-trace with full materials: against closed forms, against the diffuse tracer where both must agree, and
// against a plain integration on the CPU that chooses directions evenly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"
#include "passes/path-trace/materials.h"
#include "tests/passes/path_trace_run.h"
#include "tests/support/graph_run.h"

namespace fovea::test {
namespace {

PathTraceSettings full(uint32_t depth, uint32_t samples) {
  PathTraceSettings settings = independent(depth, samples);
  settings.full = true;
  return settings;
}

scene::Material metal(glm::vec3 color, float roughness) {
  scene::Material m;
  m.baseColor = glm::vec4(color, 1);
  m.metallic = 1;
  m.roughness = roughness;
  return m;
}

// A box whose walls emit 1 and reflect nothing, and a ball in it that reflects all light: it cannot be seen. This
// holds for every material and roughness.
TEST(PathTraceFull, WhiteBallInAWhiteFurnaceVanishes) {
  for (const float metallic : {0.0f, 0.6f, 1.0f})
    for (const float roughness : {0.05f, 0.1f, 0.4f, 1.0f}) {
      scene::Scene s;
      addMaterial(s, glm::vec3(0));
      s.materials[0].ior = 1;  // no reflection from the surface either
      s.materials[0].emission = glm::vec3(1);
      s.materials.push_back(metal(glm::vec3(1), roughness));
      s.materials[1].metallic = metallic;
      const uint32_t walls[6] = {};
      addRoom(s, walls, 2);
      addHollowSphere(s, 1, {0, 0, 0}, 0.7f, 24, 16);
      scene::Primitive& ball = s.meshes.back().primitives[0];  // turned inside out
      for (glm::vec3& n : ball.normals) n = -n;
      for (size_t i = 0; i < ball.indices.size(); i += 3) std::swap(ball.indices[i + 1], ball.indices[i + 2]);
      lookAlong(s, {0, 0, 1.9f}, {0, 0, -1}, 0.5f);
      const Traced t = trace(s, 16, full(2, 512));
      const glm::dvec3 mean = meanOf(t.radiance), error = errorOfMean(t);
      EXPECT_NEAR(mean.r, 1, 0.01) << metallic << " " << roughness;
      EXPECT_LT(error.r, 0.003) << metallic << " " << roughness;
    }
}

// A plane under a light shows the BSDF itself.
TEST(PathTraceFull, LightOnAPlaneIsTheBsdf) {
  scene::Scene s = plane(glm::vec3(0.9f, 0.5f, 0.2f));
  s.materials[0].metallic = 0.5f;
  s.materials[0].roughness = 0.4f;
  s.materials[0].clearcoat = 0.7f;
  s.materials[0].clearcoatRoughness = 0.2f;
  s.lights = {sun({0.3f, -1, 0.2f}, {3, 2, 1}), pointLight({0.4f, 1.5f, -0.3f}, {30, 20, 10})};
  const Traced t = trace(s, 16, full(2, 2));
  const scene::Geometry g = scene::flatten(s);
  const path_trace::Materials materials(s, g);
  const scene::View view = scene::makeView(s.cameras[0], {16, 16}, g);
  for (uint32_t i = 0; i < 256; ++i) {
    const glm::vec3 d = glm::normalize(view.rayDirection({float(i % 16) + 0.5f, float(i / 16) + 0.5f}));
    const glm::vec3 p = view.eye - d * (view.eye.y / d.y);
    const glm::mat3 frame = path_trace::frameAround({0, 1, 0});
    const path_trace::Bsdf bsdf(materials.at({0, 1, 0.2f, 0.2f}).bsdf, path_trace::toLocal(frame, -d));
    glm::vec3 expected(0);
    for (const scene::Light& light : s.lights) {
      const path_trace::IncidentLight l = path_trace::incidentLight(light, p);
      expected += l.irradiance * bsdf.evaluate(path_trace::toLocal(frame, l.direction));
    }
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(t.direct[i][c], expected[c], 1e-3f * expected[c]) << i;
    ASSERT_EQ(t.variance[i], glm::vec4(0, 0, 0, 1));
  }
}

// Without a reflecting surface a material is Lambertian, and both tracers agree.
TEST(PathTraceFull, LambertianSurfacesLookAsTheyDoWithDiffuseMaterials) {
  scene::Scene s;
  for (const glm::vec3 rho : {glm::vec3(0.8f), glm::vec3(0.7f, 0.2f, 0.1f), glm::vec3(0)})
    addMaterial(s, rho);
  for (scene::Material& m : s.materials) m.ior = 1;
  s.materials[2].emission = {3, 2, 1};
  const uint32_t walls[6] = {1, 0, 0, 0, 0, 0};
  addRoom(s, walls, 1);
  addQuad(s, 2, {-0.3f, 0.95f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});
  s.lights = {pointLight({0.5f, 0.2f, 0.1f}, {0.4f, 0.5f, 0.6f})};
  lookAlong(s, {0, 0, 0.95f}, {0, 0, -1}, 1.2f);
  const Traced a = trace(s, 24, full(4, 256)), b = trace(s, 24, independent(4, 256));
  double z2 = 0;
  for (size_t i = 0; i < a.direct.size(); ++i) {
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(a.direct[i][c], b.direct[i][c], 1e-4f * b.direct[i][c] + 1e-6f);
    z2 += std::pow(a.radiance[i].g - b.radiance[i].g, 2) / (a.variance[i].g + b.variance[i].g) / 576;
  }
  EXPECT_NEAR(z2, 1, 0.3);
  EXPECT_NEAR(meanOf(a.radiance).g, meanOf(b.radiance).g, 4 * (errorOfMean(a).g + errorOfMean(b).g));
}

// ---- A plain reference --------------------------------------------------------------------------------------

// Radiance along a ray by paths whose directions are even over the hemisphere, and which find emitters by chance.
class PlainPaths {
 public:
  explicit PlainPaths(const scene::Scene& s)
      : scene_(s), geometry_(scene::flatten(s)), rays_(s, geometry_), materials_(s, geometry_) {}

  glm::dvec3 radiance(glm::vec3 origin, glm::vec3 direction, uint32_t edges, uint32_t stream) const {
    const scene::RayHit hit = rays_.intersect({origin, direction});
    if (!hit) return glm::dvec3(0);
    const path_trace::SurfacePoint s = materials_.at(hit);
    if (glm::dot(s.face, direction) >= 0) return glm::dvec3(0);
    glm::dvec3 sum(s.emission);
    if (edges == 1) return sum;
    const glm::mat3 frame = path_trace::frameAround(s.normal);
    const path_trace::Bsdf bsdf(s.bsdf, path_trace::toLocal(frame, -direction));
    const glm::vec3 from = s.position + s.face * 1e-4f;
    for (const scene::Light& light : scene_.lights) {
      const path_trace::IncidentLight l = path_trace::incidentLight(light, s.position);
      if (!rays_.occluded({from, l.direction, 0, l.distance * 0.9999f}))
        sum += glm::dvec3(l.irradiance * bsdf.evaluate(path_trace::toLocal(frame, l.direction)));
    }
    const float z = uniformFloat(hashCombine(stream, 1)),
                phi = 2 * float(kPi) * uniformFloat(hashCombine(stream, 2));
    const glm::vec3 in(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z);
    return sum + 2 * kPi * glm::dvec3(bsdf.evaluate(in)) *
                     radiance(from, path_trace::toWorld(frame, in), edges - 1, hashCombine(stream, 3));
  }

 private:
  const scene::Scene& scene_;
  scene::Geometry geometry_;
  scene::RayScene rays_;
  path_trace::Materials materials_;
};

TEST(PathTraceFull, EqualsAPlainIntegration) {
  scene::Scene s;
  addMaterial(s, {0.8f, 0.7f, 0.6f});
  s.materials[0].roughness = 0.5f;
  s.materials.push_back(metal({0.9f, 0.6f, 0.3f}, 0.5f));
  addMaterial(s, glm::vec3(0.1f));
  s.materials[2].emission = {3, 2, 1};
  addMaterial(s, {0.1f, 0.3f, 0.6f});
  s.materials[3].clearcoat = 1;
  s.materials[3].clearcoatRoughness = 0.5f;
  s.materials[3].specularColor = {0.5f, 2, 1};
  const uint32_t walls[6] = {1, 0, 3, 2, 1, 0};
  addRoom(s, walls, 1);
  s.lights = {pointLight({0.5f, 0.2f, 0.1f}, {0.4f, 0.5f, 0.6f})};
  lookAlong(s, {0, 0, 0.95f}, {0, -0.3f, -1}, 1.2f);
  constexpr uint32_t kSide = 8, kSamples = 20000;
  const Traced t = trace(s, kSide, full(3, 2048));
  const PlainPaths plain(s);
  const scene::View view = scene::makeView(s.cameras[0], {kSide, kSide}, scene::flatten(s));
  double z2 = 0, sum = 0, wanted = 0;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const glm::vec3 d = glm::normalize(view.rayDirection({float(i % kSide) + 0.5f, float(i / kSide) + 0.5f}));
    double mean = 0, squares = 0;
    for (uint32_t k = 0; k < kSamples; ++k) {
      const double l = plain.radiance(view.eye, d, 3, randomStream(9, i, 0, k)).g;
      mean += l / kSamples;
      squares += l * l / kSamples;
    }
    z2 += std::pow(mean - t.radiance[i].g, 2) / ((squares - mean * mean) / kSamples + t.variance[i].g) /
          double(kSide * kSide);
    sum += t.radiance[i].g;
    wanted += mean;
  }
  EXPECT_NEAR(sum / wanted, 1, 0.005);
  EXPECT_NEAR(z2, 1, 0.5) << "of 64 pixels; heavy tails widen the spread of 0.18";
}

// ---- Glass --------------------------------------------------------------------------------------------------

// A floor with a pane between it and both eye and light.
scene::Scene underGlass(scene::Material glass) {
  scene::Scene s = plane({0.6f, 0.5f, 0.4f});
  glass.transmission = 1;
  s.materials.push_back(glass);
  addQuad(s, 1, {-10, 1, 10}, {20, 0, 0}, {0, 0, -20});
  s.lights = {sun({0.2f, -1, 0.1f}, {3, 2, 1})};
  return s;
}

TEST(PathTraceFull, GlassWithoutReflectionAndTintIsInvisible) {
  scene::Material glass;
  glass.ior = 1;
  const scene::Scene s = underGlass(glass), open = [&] {
    scene::Scene o = s;
    o.nodes.resize(1);
    return o;
  }();
  const Traced a = trace(s, 12, full(2, 2)), b = trace(open, 12, full(2, 2));
  for (size_t i = 0; i < a.direct.size(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(a.direct[i][c], b.direct[i][c], 1e-5f * b.direct[i][c]);
}

// Light is tinted on its way in and on its way out.
TEST(PathTraceFull, TintedGlassTintsTwice) {
  scene::Material glass;
  glass.ior = 1;
  const scene::Scene open = underGlass(glass);
  glass.baseColor = {0.9f, 0.5f, 0.2f, 1};
  const scene::Scene s = underGlass(glass);
  const Traced a = trace(s, 12, full(2, 2)), b = trace(open, 12, full(2, 2));
  for (size_t i = 0; i < a.direct.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(a.direct[i][c], b.direct[i][c] * glass.baseColor[c] * glass.baseColor[c], 1e-4f);
}

// In the furnace a pane of glass vanishes, too: what it does not reflect goes through.
TEST(PathTraceFull, GlassInAWhiteFurnaceVanishes) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0));
  s.materials[0].ior = 1;
  s.materials[0].emission = glm::vec3(1);
  addMaterial(s, glm::vec3(1));
  s.materials[1].transmission = 1;
  s.materials[1].roughness = 0.3f;
  const uint32_t walls[6] = {};
  addRoom(s, walls, 2);
  addQuad(s, 1, {-0.5f, -0.5f, 0.3f}, {1, 0, 0}, {0, 1, 0});
  addQuad(s, 1, {-0.5f, -0.5f, -0.3f}, {1, 0, 0.2f}, {0, 1, 0});
  lookAlong(s, {0.3f, 0, 1.9f}, {-0.2f, 0, -1}, 0.6f);
  const Traced t = trace(s, 16, full(4, 256));
  EXPECT_NEAR(meanOf(t.radiance).g, 1, 0.005);
}

// ---- alphaMode BLEND ------------------------------------------------------------------------------------------

scene::Material veil(glm::vec3 color, float alpha) {
  scene::Material m;
  m.baseColor = glm::vec4(color, alpha);
  m.ior = 1;
  m.masked = m.blended = m.doubleSided = true;
  return m;
}

// Of light that passes through a BLEND surface onto a floor, 1 - alpha arrives, and the same share of that reaches the
// eye. The veil shows alpha of its own light.
TEST(PathTraceFull, VeilsCoverTheShareOfTheirAlpha) {
  for (const float alpha : {0.0f, 0.3f, 0.8f, 1.0f}) {
    scene::Scene s = plane({0.6f, 0.5f, 0.4f});
    s.materials[0].ior = 1;
    const scene::Scene open = [&] {
      scene::Scene o = s;
      o.lights = {sun({0.2f, -1, 0.1f}, {3, 2, 1})};
      return o;
    }();
    const glm::vec3 color(0.1f, 0.8f, 0.3f);
    s.materials.push_back(veil(color, alpha));
    addQuad(s, 1, {-10, 1, 10}, {20, 0, 0}, {0, 0, -20});
    s.lights = open.lights;
    const Traced a = trace(s, 8, full(2, 2)), b = trace(open, 8, full(2, 2));
    const glm::vec3 floor{0.6f, 0.5f, 0.4f};
    for (size_t i = 0; i < a.direct.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const float whole = b.direct[i][c];
        ASSERT_NEAR(a.direct[i][c], alpha * whole * color[c] / floor[c] + (1 - alpha) * (1 - alpha) * whole,
                    1e-4f)
            << alpha;
      }
  }
}

// BLEND surfaces that reflect all light vanish in the furnace whatever their alpha: paths pass them without bias.
TEST(PathTraceFull, VeilsInAWhiteFurnaceVanish) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0));
  s.materials[0].ior = 1;
  s.materials[0].emission = glm::vec3(1);
  s.materials.push_back(veil(glm::vec3(1), 0.4f));
  s.materials.push_back(veil(glm::vec3(1), 0.9f));
  const uint32_t walls[6] = {};
  addRoom(s, walls, 2);
  addQuad(s, 1, {-0.5f, -0.5f, 0.3f}, {1, 0, 0}, {0, 1, 0});
  addQuad(s, 2, {-0.5f, -0.5f, -0.3f}, {1, 0, 0.2f}, {0, 1, 0});
  lookAlong(s, {0.3f, 0, 1.9f}, {-0.2f, 0, -1}, 0.6f);
  const Traced t = trace(s, 16, full(6, 256));
  EXPECT_NEAR(meanOf(t.radiance).g, 1, 0.01);
}

TEST(PathTraceFull, UnlitSurfacesShowTheirColourAndLightNothing) {
  scene::Scene s = plane(glm::vec3(0.5f));
  scene::Material sign;
  sign.baseColor = {0.2f, 0.4f, 0.6f, 1};
  sign.emission = glm::vec3(9);
  sign.unlit = true;
  s.materials.push_back(sign);
  addQuad(s, 1, {-0.2f, 1, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f});
  s.lights = {sun({0, -1, 0}, glm::vec3(5))};
  const Traced t = trace(s, 15, full(4, 16));
  EXPECT_EQ(t.radiance[7 * 15 + 7], glm::vec4(0.2f, 0.4f, 0.6f, 1));
  EXPECT_EQ(meanOf(t.indirect), glm::dvec3(0));
}

// ---- The pass -----------------------------------------------------------------------------------------------

TEST(PathTraceFull, IsAParameterOfThePass) {
  scene::Scene s = plane(glm::vec3(0.9f));
  s.materials[0].metallic = 1;
  s.lights = {sun({0, -1, 0}, glm::vec3(5))};
  PassTest test("path-trace");
  test.scene(s).viewSize(9, 9).param("spp", 2).view("materials", "diffuse");
  test.run();
  EXPECT_EQ(test.values<glm::vec4>("radiance")[40], glm::vec4(0, 0, 0, 1));
  PassTest shiny("path-trace");
  shiny.scene(s).viewSize(9, 9).param("spp", 2).view("materials", "full");
  shiny.run();
  EXPECT_GT(shiny.values<glm::vec4>("radiance")[40].r, 0.5f);
}

}  // namespace
}  // namespace fovea::test
