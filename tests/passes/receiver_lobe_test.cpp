// Tests the lobes under which pass near-field finds light: against the formula, and under a white sky.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/environment/environment_map.h"
#include "passes/path-trace/directions.h"
#include "tests/passes/full_materials_reference.h"
#include "tests/passes/near_field_run.h"
#include "tests/references/blocks.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr glm::uvec2 kSize(32, 24);
const glm::vec3 kUp(0, 1, 0);

// What the G-buffer says of a pixel of a floor that the eye looks down on.
struct Lobe {
  float f0 = 0.04f, roughness = 0.5f;
  glm::vec3 normal = kUp;
};

// A sample of the floor: how much it responds to the light that it gets, in units of irradiance / pi.
struct Response {
  glm::vec3 position, out;  // out: unit, to the eye
  float response, light;    // light: irradiance / pi
  double cosine() const { return double(out.y); }
};

// The floor, from grazing to steep.
scene::Scene floorInView() {
  scene::Scene s;
  addQuad(s, addMaterial(s, glm::vec3(0)), {-500, 0, 500}, {1000, 0, 0}, {0, 0, -1000});
  scene::Camera& camera = s.cameras.emplace_back();
  camera.position = {0, 1, 0};
  camera.orientation = glm::angleAxis(-0.7f, glm::vec3(1, 0, 0));
  camera.verticalFov = 1;
  return s;
}

std::vector<Response> responsesOf(const scene::Scene& s, uint32_t frames, const Lobe& lobe) {
  NearFieldTest test(s, kSize);
  const size_t pixels = kSize.x * kSize.y;
  test.view("materials", "full");
  test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, kSize.x, kSize.y, 1,
             std::vector<uint64_t>(pixels, glm::packHalf4x16(glm::vec4(lobe.normal, 1))));
  test.image("gbuffer.specular", VK_FORMAT_R16G16B16A16_SFLOAT, kSize.x, kSize.y, 1,
             std::vector<uint64_t>(pixels, glm::packHalf4x16(glm::vec4(glm::vec3(lobe.f0), lobe.roughness))));
  const NearFieldMeans means(test, frames);
  const std::vector<glm::vec4>&light = means.samples, &gloss = means.gloss;
  const scene::View& view = test.lastFrame().views[0];
  std::vector<Response> result;
  for (uint32_t i = 0; i < light.size(); ++i) {
    const glm::uvec2 block(i % (kSize.x / 2), i / (kSize.x / 2));
    const glm::uvec2 pixel = 2u * block + passes::samplePixel(1, 2, block);  // of the first frame
    const glm::vec3 ray = glm::normalize(view.rayDirection(glm::vec2(pixel) + 0.5f));
    EXPECT_LT(ray.y, 0);
    EXPECT_GT(light[i].g, 0);
    result.push_back({view.eye - ray * (view.eye.y / ray.y), -ray, gloss[i].g / light[i].g, light[i].g});
  }
  return result;
}

// The only light is a panel that is small and far away, in this direction.
std::vector<Response> responsesTo(glm::vec3 direction, const Lobe& lobe) {
  scene::Scene s = floorInView();
  const uint32_t panel = addMaterial(s, glm::vec3(0));
  s.materials[panel].emission = glm::vec3(4e6f);
  s.materials[panel].doubleSided = true;
  const glm::mat3 axes = scene::orthonormalFrame(direction);
  addQuad(s, panel, 400.0f * direction, 0.1f * axes[0], 0.1f * axes[1]);
  return responsesOf(s, 1, lobe);
}
glm::vec3 toPanel(glm::vec3 direction, const Response& r) {
  return glm::normalize(400.0f * direction - r.position);
}

const glm::vec3 kDirections[] = {glm::normalize(glm::vec3(0.2f, 0.5f, -1)),
                                 glm::normalize(glm::vec3(1, 1, 1)),
                                 glm::normalize(glm::vec3(-1, 0.3f, -0.2f))};

// What microfacets reflect of light that they scatter once, times pi and divided by its cosine and by their albedo.
double microfacets(glm::dvec3 n, glm::dvec3 v, glm::dvec3 d, float roughness) {
  const double alpha = double(roughness) * double(roughness), a2 = alpha * alpha;
  const glm::dvec3 h = glm::normalize(d + v);
  const double nh = glm::dot(n, h), nv = glm::dot(n, v), nl = glm::dot(n, d);
  const double density = a2 / (glm::pi<double>() * std::pow(nh * nh * (a2 - 1) + 1, 2));
  const auto smith = [&](double c) { return std::sqrt(a2 + (1 - a2) * c * c); };
  const double albedo = double(path_trace::AlbedoTable::schlick().at(float(nv), roughness).ofMirror());
  return glm::pi<double>() * density * 0.5 / (nl * smith(nv) + nv * smith(nl)) / albedo;
}

// Both outputs are half floats, each rounded by up to 5e-4.
TEST(LongReceiverLobe, IsThatOfTheMicrofacets) {
  const Lobe lobe{1e-4f, 0.5f};  // so little that none is scattered twice
  for (const glm::vec3 direction : kDirections)
    for (const Response& r : responsesTo(direction, lobe)) {
      const double want = microfacets(kUp, r.out, toPanel(direction, r), lobe.roughness);
      EXPECT_NEAR(r.response, want, 4e-3 * want) << r.cosine();
    }
}

// A white metal, whose microfacets scatter everything in the end.
TEST(LongReceiverLobe, HasWhatIsScatteredMoreThanOnce) {
  const path_trace::BsdfParameters white = bsdfParameters(glm::vec3(1), 1, 1);
  for (const glm::vec3 direction : kDirections)
    for (const Response& r : responsesTo(direction, {1, 1})) {
      const glm::mat3 frame = path_trace::frameAround(kUp);
      const path_trace::Bsdf bsdf(white, path_trace::toLocal(frame, r.out));
      const glm::vec3 to = toPanel(direction, r);
      const double want =
          glm::pi<double>() * double(bsdf.evaluate(path_trace::toLocal(frame, to)).x) / double(to.y);
      EXPECT_NEAR(r.response, want, 0.01 * want) << r.cosine();
    }
}

scene::Scene underWhiteSky() {
  scene::Scene s = floorInView();
  s.environmentMap = std::make_shared<scene::EnvironmentMap>(4, 2, std::vector(8, glm::vec3(1)));
  return s;
}

double meanResponse(const std::vector<Response>& responses) {
  double sum = 0;
  for (const Response& r : responses) sum += double(r.response) / double(responses.size());
  return sum;
}

TEST(LongReceiverLobe, AddsUpToOneOverAllDirections) {
  for (const float f0 : {0.04f, 0.9f})
    for (const float roughness : {0.4f, 0.7f, 1.0f})
      EXPECT_NEAR(meanResponse(responsesOf(underWhiteSky(), 4, {f0, roughness})), 1, 0.015)
          << f0 << " " << roughness;
}

// A normal map bends the normal by which light counts. Of an even light what is beneath the surface is lost, and up to
// 0.04 because of the bound on what the least cosines may count.
TEST(LongReceiverLobe, AddsUpToOneAroundABentNormal) {
  for (const float tilt : {0.15f, 0.4f})
    for (const float roughness : {0.4f, 0.7f, 1.0f}) {
      const glm::vec3 bent = glm::normalize(glm::vec3(0.3f * std::sin(tilt), std::cos(tilt), std::sin(tilt)));
      const std::vector<Response> responses = responsesOf(underWhiteSky(), 4, {0.04f, roughness, bent});
      double beneath = 0;
      constexpr uint32_t kDirectionCount = 200;
      for (const Response& r : responses)
        for (uint32_t i = 0; i < kDirectionCount; ++i) {
          const float u = (float(i) + 0.5f) / kDirectionCount, v = uniformFloat(i * 2654435769u);
          const glm::vec3 local(std::sqrt(u) * std::cos(glm::two_pi<float>() * v),
                                std::sqrt(u) * std::sin(glm::two_pi<float>() * v), std::sqrt(1 - u));
          const glm::vec3 d = path_trace::toWorld(path_trace::frameAround(bent), local);
          if (d.y < 0)
            beneath += microfacets(bent, r.out, d, roughness) / kDirectionCount / double(responses.size());
        }
      EXPECT_NEAR(meanResponse(responses) + beneath, 1, 0.05) << tilt << " " << roughness;
    }
}

TEST(LongReceiverLobe, IsNoSmootherThanWhatIsTraced) {
  const glm::vec3 direction = kDirections[0];
  const auto responses = [&](float f0, float roughness) {
    std::vector<float> list;
    for (const Response& r : responsesTo(direction, {f0, roughness})) list.push_back(r.response);
    return list;
  };
  // Both outputs are half floats.
  const auto expectSame = [](const std::vector<float>& a, const std::vector<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 3e-3f * b[i]) << i;
  };
  expectSame(responses(0.04f, 0.05f), responses(0.04f, 0.3f));
  expectSame(responses(0.9f, 0.05f), responses(0.9f, 0.7f));
  EXPECT_GT(std::ranges::max(responses(0.04f, 0.3f)), std::ranges::max(responses(0.04f, 0.4f)));
}

TEST(LongReceiverLobe, LightFromBehindAddsNothing) {
  const glm::vec3 away = glm::normalize(glm::vec3(0, 0.5f, 1));
  for (const Response& r : responsesTo(kDirections[0], {0.04f, 0.5f, away})) EXPECT_EQ(r.response, 0);
}

TEST(LongReceiverLobe, WithoutOneLightIsThatOfTheDiffuseLayer) {
  for (const Response& r : responsesTo(kDirections[1], {0, 0.5f})) EXPECT_EQ(r.response, 1);
}

}  // namespace
}  // namespace fovea::test
