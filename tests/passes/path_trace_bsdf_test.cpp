// Tests the path tracer's BSDF against what every BSDF has to obey, and against known values.
#include "passes/path-trace/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "framework/base/random.h"
#include "passes/path-trace/microfacets.h"

namespace fovea::path_trace {
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

// Smooth and rough, metals and dielectrics, plain and with everything that there is.
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

float number(uint32_t stream, uint32_t i, uint32_t k) { return uniformFloat(randomStream(stream, 0, i, k)); }

// Integral over the hemisphere by midpoints of the polar angles.
glm::dvec3 overHemisphere(const std::function<glm::dvec3(glm::vec3)>& f) {
  constexpr int kRows = 300, kColumns = 600;  // a lobe at a grazing angle is narrow around the normal
  glm::dvec3 sum(0);
  for (int i = 0; i < kRows; ++i)
    for (int k = 0; k < kColumns; ++k) {
      const double theta = kPi / 2 * (i + 0.5) / kRows;
      sum += f(direction(float(std::cos(theta)), float(2 * kPi * (k + 0.5) / kColumns))) * std::sin(theta);
    }
  return sum * (kPi * kPi / (kRows * kColumns));
}

// Mean weight of many samples, and the share of them that there are.
struct Sampled {
  glm::dvec3 albedo{0};
  double share = 0;
};
Sampled sampled(const Bsdf& bsdf, uint32_t count) {
  Sampled mean;
  for (uint32_t i = 0; i < count; ++i)
    if (const auto s = bsdf.sample(number(5, i, 0), number(5, i, 1), number(5, i, 2))) {
      mean.albedo += glm::dvec3(s->weight) / double(count);
      mean.share += 1.0 / count;
    }
  return mean;
}

TEST(PathTraceBsdf, IsReciprocal) {
  for (const BsdfParameters& p : kinds())
    for (uint32_t i = 0; i < 200; ++i) {
      const glm::vec3 a = direction(0.02f + 0.98f * number(1, i, 0), 6 * number(1, i, 1)),
                      b = direction(0.02f + 0.98f * number(1, i, 2), 6 * number(1, i, 3));
      const glm::vec3 ab = Bsdf(p, a).evaluate(b) / b.z, ba = Bsdf(p, b).evaluate(a) / a.z;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(ab[c], ba[c], 2e-5f * ab[c]) << p.roughness << " " << p.metallic;
    }
}

// Within five standard errors of the samples, and the error of the midpoints.
TEST(PathTraceBsdf, SamplesFollowTheirDensityAndAreWorthTheIntegral) {
  constexpr uint32_t kSamples = 1 << 16;
  for (const BsdfParameters& p : kinds())
    for (const float cosine : {1.0f, 0.6f, 0.15f}) {
      const Bsdf bsdf(p, direction(cosine, 1));
      const Sampled s = sampled(bsdf, kSamples);
      const double density = overHemisphere([&](glm::vec3 in) { return glm::dvec3(bsdf.density(in)); }).x;
      const glm::dvec3 albedo = overHemisphere([&](glm::vec3 in) { return glm::dvec3(bsdf.evaluate(in)); });
      ASSERT_NEAR(density, s.share, 5 * std::sqrt(s.share * (1 - s.share) / kSamples) + 2e-3)
          << p.roughness << " " << p.metallic << " " << cosine;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(s.albedo[c], albedo[c], 0.01 * albedo[c] + 5e-4)
            << p.roughness << " " << p.metallic << " " << cosine;
    }
}

// Each part of the hemisphere gets as many samples as its density says.
TEST(PathTraceBsdf, SamplesLieWhereTheirDensitySays) {
  constexpr int kRows = 8, kColumns = 8, kFine = 24;
  constexpr uint32_t kSamples = 1 << 18;
  for (const float roughness : {0.4f, 0.9f}) {
    const Bsdf bsdf(parameters(roughness, 1), direction(0.5f, 2));
    std::vector<double> found(kRows * kColumns), wanted(kRows * kColumns);
    for (uint32_t i = 0; i < kSamples; ++i)
      if (const auto s = bsdf.sample(number(7, i, 0), number(7, i, 1), number(7, i, 2))) {
        const double phi = std::atan2(s->in.y, s->in.x) + kPi;
        found[size_t(std::min(int(s->in.z * kRows), kRows - 1) * kColumns +
                     std::min(int(phi / (2 * kPi) * kColumns), kColumns - 1))] += 1;
      }
    for (int i = 0; i < kRows * kFine; ++i)
      for (int k = 0; k < kColumns * kFine; ++k) {
        const double z = (i + 0.5) / (kRows * kFine), phi = 2 * kPi * (k + 0.5) / (kColumns * kFine) - kPi;
        wanted[size_t(i / kFine * kColumns + k / kFine)] +=
            double(kSamples) * double(bsdf.density(direction(float(z), float(phi)))) * 2 * kPi /
            (kRows * kFine * kColumns * kFine);
      }
    for (size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], wanted[i], 5 * std::sqrt(wanted[i]) + 0.01 * wanted[i]) << roughness << " " << i;
  }
}

TEST(PathTraceBsdf, WhiteSurfacesReflectAllLight) {
  for (const float roughness : {0.05f, 0.1f, 0.2f, 0.33f, 0.5f, 0.75f, 0.9f, 1.0f})
    for (const float metallic : {0.0f, 0.5f, 1.0f})
      for (const float transmission : {0.0f, 1.0f})
        for (const float cosine : {1.0f, 0.7f, 0.4f, 0.2f, 0.1f, 0.05f}) {
          BsdfParameters p = parameters(roughness, metallic);
          p.transmission = transmission;
          const Bsdf bsdf(p, direction(cosine, 0));
          const double albedo = sampled(bsdf, 1 << 15).albedo.x + double(bsdf.transmittance().x);
          ASSERT_NEAR(albedo, 1, 0.01) << "roughness " << roughness << ", metallic " << metallic
                                       << ", transmission " << transmission << ", cosine " << cosine;
        }
}

// Colours must not gain from what is scattered more than once; nor may a coat add light.
TEST(PathTraceBsdf, NothingReflectsMoreThanItGets) {
  for (BsdfParameters p : kinds())
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
      p.baseColor = glm::vec3(1);
      for (const float coat : {0.0f, 1.0f}) {
        p.clearcoat = coat;
        const Bsdf bsdf(p, direction(cosine, 0));
        const double albedo = sampled(bsdf, 1 << 14).albedo.x + double(bsdf.transmittance().x);
        ASSERT_LE(albedo, 1.01) << p.roughness << " " << p.metallic << " " << coat << " " << cosine;
        ASSERT_GE(albedo, coat > 0 ? 0.85 : 0.99);
      }
    }
}

// A surface with index of refraction 1 is not there: what is left is the diffuse layer.
TEST(PathTraceBsdf, WithoutASurfaceItIsLambertian) {
  BsdfParameters p = parameters(0.5f, 0);
  p.ior = 1;
  p.dielectricAlbedo = &AlbedoTable::dielectric(1);
  p.specularF0 = glm::vec3(0);
  p.baseColor = {0.8f, 0.4f, 0.2f};
  const Bsdf bsdf(p, direction(0.5f, 0));
  for (const float cosine : {0.1f, 0.5f, 1.0f})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(bsdf.evaluate(direction(cosine, 2))[c], p.baseColor[c] * cosine / float(kPi), 1e-5f);
  EXPECT_EQ(bsdf.evaluate(direction(-0.3f, 1)), glm::vec3(0));
  EXPECT_EQ(bsdf.density(direction(-0.3f, 1)), 0);
}

// The area that the microfacets seen from a direction fill is the one that the surface fills (Heitz 2014, Eq. 14).
TEST(PathTraceBsdf, VisibleMicrofacetsCoverTheSurface) {
  for (const float width : {0.2f, 0.5f, 1.0f})
    for (const float cosine : {0.1f, 0.5f, 1.0f}) {
      const glm::vec3 out = direction(cosine, 0.5f);
      const double unshadowed =
          overHemisphere([&](glm::vec3 h) {
            return glm::dvec3(double(ggxDensity(h, width)) * std::max(double(glm::dot(out, h)), 0.0));
          }).x;
      const double visible = 2 * double(out.z) / double(out.z + smithTerm(out, width));
      EXPECT_NEAR(visible * unshadowed, double(cosine), 0.01 * double(cosine)) << width << " " << cosine;
    }
}

// The tables hold what a mirror of microfacets reflects altogether.
TEST(PathTraceBsdf, AlbedosAreIntegrals) {
  for (const float roughness : {0.3f, 0.5f, 0.9f})
    for (const float cosine : {0.3f, 0.6f, 1.0f}) {
      const glm::vec3 out = direction(cosine, 0.5f);
      const double mirror = overHemisphere([&](glm::vec3 in) {
                              const glm::vec3 h = glm::normalize(in + out);
                              return glm::dvec3(mirrorBrdf(in, out, h, ggxWidth(roughness)) * in.z);
                            }).x;
      for (const AlbedoTable* table : {&AlbedoTable::schlick(), &AlbedoTable::dielectric(1.5f)})
        EXPECT_NEAR(table->at(cosine, roughness).ofMirror(), mirror, 1e-3) << roughness << " " << cosine;
    }
}

// Born and Wolf, "Principles of Optics", section 1.5.3: at normal incidence, at Brewster's angle, where half the light
// is reflected as if it were alone, and at grazing incidence.
TEST(PathTraceBsdf, ReflectanceOfGlass) {
  EXPECT_NEAR(fresnelReflectance(1, 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnelReflectance(0, 1.5f), 1, 1e-6f);
  const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f), s = (1 - 1.5f * 1.5f) / (1 + 1.5f * 1.5f);
  EXPECT_NEAR(fresnelReflectance(brewster, 1.5f), 0.5f * s * s, 1e-6f);
  EXPECT_EQ(normalReflectance(0), 1);
  for (const float cosine : {0.0f, 0.1f, 0.5f, 1.0f})
    EXPECT_NEAR(0.04f + 0.96f * fresnelCurve(cosine, 1.5f), fresnelReflectance(cosine, 1.5f), 1e-6f);
}

}  // namespace
}  // namespace fovea::path_trace
