// Tests the BSDF of full materials against the laws that every BSDF has to obey, and against known values.
#include "framework/scene/materials/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/random.h"
#include "framework/scene/materials/microfacets.h"

namespace fovea::scene {
namespace {

constexpr double kPi = glm::pi<double>();

BsdfParameters parameters(float roughness, float metallic) {
  BsdfParameters p;
  p.roughness = roughness;
  p.metallic = metallic;
  p.metalAlbedo = &AlbedoTable::schlick();
  p.dielectricAlbedo = p.coatAlbedo = &AlbedoTable::dielectric(1.5f);
  return p;
}

// One of each kind, coloured.
std::vector<BsdfParameters> kinds() {
  std::vector<BsdfParameters> list;
  for (const float roughness : {0.3f, 0.6f, 1.0f})
    for (const float metallic : {0.0f, 0.4f, 1.0f}) {
      BsdfParameters p = parameters(roughness, metallic);
      p.baseColor = {0.9f, 0.5f, 0.1f};
      list.push_back(p);
      p.specularF0 = {0.02f, 0.05f, 0.03f};
      p.specularF90 = 0.7f;
      p.ior = 1.33f;
      p.dielectricAlbedo = &AlbedoTable::dielectric(p.ior);
      p.transmission = 0.3f;
      p.clearcoat = 0.8f;
      p.clearcoatRoughness = 0.4f;
      list.push_back(p);
    }
  return list;
}

glm::vec3 direction(float cosine, float phi) {
  const float sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// Integral over the hemisphere by midpoints of the polar angles.
glm::dvec3 overHemisphere(const std::function<glm::dvec3(glm::vec3)>& f) {
  constexpr int kRows = 600, kColumns = 300;
  glm::dvec3 sum(0);
  for (int i = 0; i < kRows; ++i)
    for (int k = 0; k < kColumns; ++k) {
      const double theta = kPi / 2 * (i + 0.5) / kRows;
      sum += f(direction(float(std::cos(theta)), float(2 * kPi * (k + 0.5) / kColumns))) * std::sin(theta);
    }
  return sum * (kPi * kPi / (kRows * kColumns));
}

std::optional<Bsdf::Sample> randomSample(const Bsdf& bsdf, uint32_t stream, uint32_t i) {
  const auto random = [&](uint32_t k) { return uniformFloat(randomStream(stream, 0, i, k)); };
  return bsdf.sample(random(0), random(1), random(2));
}

// Mean weight of many samples: the albedo.
glm::dvec3 sampledAlbedo(const Bsdf& bsdf, uint32_t count) {
  glm::dvec3 sum(0);
  for (uint32_t i = 0; i < count; ++i)
    if (const auto s = randomSample(bsdf, 5, i)) sum += glm::dvec3(s->weight);
  return sum / double(count);
}

TEST(Bsdf, IsReciprocal) {
  for (const BsdfParameters& p : kinds())
    for (uint32_t i = 0; i < 200; ++i) {
      const auto random = [&](uint32_t k) { return uniformFloat(randomStream(1, 0, i, k)); };
      const glm::vec3 a = direction(0.02f + 0.98f * random(0), 6 * random(1)),
                      b = direction(0.02f + 0.98f * random(2), 6 * random(3));
      const glm::vec3 ab = Bsdf(p, a).evaluate(b) / b.z, ba = Bsdf(p, b).evaluate(a) / a.z;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(ab[c], ba[c], 2e-5f * ab[c]) << p.roughness << " " << p.metallic;
    }
}

TEST(Bsdf, DensityIntegratesToTheShareOfSamplesAboveTheSurface) {
  for (const BsdfParameters& p : kinds())
    for (const float cosine : {1.0f, 0.6f, 0.15f}) {
      const Bsdf bsdf(p, direction(cosine, 1));
      const double integral = overHemisphere([&](glm::vec3 in) { return glm::dvec3(bsdf.density(in)); }).x;
      constexpr int kSamples = 1 << 16;
      int above = 0;
      for (uint32_t i = 0; i < kSamples; ++i) above += randomSample(bsdf, 2, i).has_value();
      // Five standard errors, and the error of the midpoints.
      const double share = double(above) / kSamples;
      ASSERT_NEAR(integral, share, 5 * std::sqrt(share * (1 - share) / kSamples) + 2e-3)
          << p.roughness << " " << p.metallic << " " << cosine;
      ASSERT_LE(integral, 1.002);
    }
}

TEST(Bsdf, SamplesHaveTheDensityAndValueOfTheirDirection) {
  for (const BsdfParameters& p : kinds()) {
    const Bsdf bsdf(p, direction(0.5f, 2));
    for (uint32_t i = 0; i < 100; ++i) {
      const auto s = randomSample(bsdf, 3, i);
      if (!s) continue;
      ASSERT_NEAR(glm::length(s->in), 1, 1e-5);
      ASSERT_EQ(s->density, bsdf.density(s->in));
      ASSERT_EQ(s->weight, bsdf.evaluate(s->in) / s->density);
    }
  }
}

TEST(Bsdf, MeanOfTheSamplesIsTheIntegral) {
  for (const BsdfParameters& p : kinds())
    for (const float cosine : {0.9f, 0.3f}) {
      const Bsdf bsdf(p, direction(cosine, 0.5f));
      const glm::dvec3 integral = overHemisphere([&](glm::vec3 in) { return glm::dvec3(bsdf.evaluate(in)); });
      const glm::dvec3 sampled = sampledAlbedo(bsdf, 1 << 18);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(sampled[c], integral[c], 0.005 * integral[c] + 1e-4)
            << p.roughness << " " << p.metallic << " " << cosine;
    }
}

TEST(Bsdf, WhiteSurfacesReflectAllLight) {
  for (const float roughness : {0.05f, 0.1f, 0.2f, 0.33f, 0.5f, 0.75f, 0.9f, 1.0f})
    for (const float metallic : {0.0f, 0.5f, 1.0f})
      for (const float transmission : {0.0f, 1.0f})
        for (const float cosine : {1.0f, 0.7f, 0.4f, 0.2f, 0.1f, 0.05f}) {
          BsdfParameters p = parameters(roughness, metallic);
          p.transmission = transmission;
          const Bsdf bsdf(p, direction(cosine, 0));
          const double albedo = sampledAlbedo(bsdf, 1 << 16).x + double(bsdf.transmittance().x);
          ASSERT_NEAR(albedo, 1, 0.01) << "roughness " << roughness << ", metallic " << metallic
                                       << ", transmission " << transmission << ", cosine " << cosine;
        }
}

// Colours must not gain from the lobe of multiple scattering; nor may a coat add light.
TEST(Bsdf, NothingReflectsMoreThanItGets) {
  for (BsdfParameters p : kinds())
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
      p.baseColor = glm::vec3(1);
      for (const float coat : {0.0f, 1.0f}) {
        p.clearcoat = coat;
        const Bsdf bsdf(p, direction(cosine, 0));
        const double albedo = sampledAlbedo(bsdf, 1 << 14).x + double(bsdf.transmittance().x);
        ASSERT_LE(albedo, 1.01) << p.roughness << " " << p.metallic << " " << coat << " " << cosine;
        ASSERT_GE(albedo, coat > 0 ? 0.85 : 0.99);
      }
    }
}

TEST(Bsdf, BelowTheSurfaceThereIsNothing) {
  const Bsdf bsdf(parameters(0.5f, 0.5f), direction(0.5f, 0));
  EXPECT_EQ(bsdf.evaluate(direction(-0.3f, 1)), glm::vec3(0));
  EXPECT_EQ(bsdf.density(direction(-0.3f, 1)), 0);
}

// A surface with index of refraction 1 is invisible: only the diffuse layer remains.
TEST(Bsdf, WithoutASurfaceItIsLambertian) {
  BsdfParameters p = parameters(0.5f, 0);
  p.ior = 1;
  p.dielectricAlbedo = &AlbedoTable::dielectric(1);
  p.specularF0 = glm::vec3(0);
  p.baseColor = {0.8f, 0.4f, 0.2f};
  const Bsdf bsdf(p, direction(0.5f, 0));
  for (const float cosine : {0.1f, 0.5f, 1.0f})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(bsdf.evaluate(direction(cosine, 2))[c], p.baseColor[c] * cosine / float(kPi), 1e-5f);
}

// Born and Wolf, "Principles of Optics", section 1.5.3: at normal incidence, at Brewster's angle, where half the light
// is reflected as if it were alone, and at grazing incidence.
TEST(Bsdf, ReflectanceOfGlass) {
  EXPECT_NEAR(dielectricReflectance(1, 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(dielectricReflectance(0, 1.5f), 1, 1e-6f);
  const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f);
  const float s = (1 - 1.5f * 1.5f) / (1 + 1.5f * 1.5f);
  EXPECT_NEAR(dielectricReflectance(brewster, 1.5f), 0.5f * s * s, 1e-6f);
  EXPECT_EQ(normalReflectance(0), 1);
  for (const float cosine : {0.0f, 0.1f, 0.5f, 1.0f})
    EXPECT_NEAR(0.04f + 0.96f * dielectricCurve(cosine, 1.5f), dielectricReflectance(cosine, 1.5f), 1e-6f);
}

}  // namespace
}  // namespace fovea::scene
