// Tests the lobes under which pass near-field finds light: against the formula, and in a white furnace.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/scene/rays/surface_tracer.h"
#include "passes/near-field/receiver_lobe.h"
#include "passes/path-trace/directions.h"
#include "tests/passes/full_materials_reference.h"

namespace fovea::test {
namespace {

using passes::ReceiverLobe;

const glm::vec3 kNormal = glm::normalize(glm::vec3(0.3f, 1, -0.2f));
constexpr int kDirections = 400000;

glm::vec3 toEye(float cosine) {
  const glm::vec3 across = glm::normalize(glm::cross(kNormal, glm::vec3(1, 0, 0)));
  return cosine * kNormal + std::sqrt(1 - cosine * cosine) * across;
}

// cosine: between the normal and the direction to the eye.
ReceiverLobe lobe(float f0, float roughness, float cosine) {
  return {glm::vec4(kNormal, 1), glm::vec4(glm::vec3(f0), roughness), toEye(cosine)};
}

// With the irradiance measured by the same normal.
float respond(const ReceiverLobe& l, glm::vec3 direction) {
  return l.response(direction, glm::dot(kNormal, direction));
}

TEST(ReceiverLobe, AddsUpToOneOverAllDirections) {
  for (const float f0 : {0.04f, 0.9f})
    for (const float roughness : {0.4f, 0.6f, 0.8f, 1.0f})
      for (const float cosine : {0.1f, 0.4f, 1.0f}) {
        const ReceiverLobe l = lobe(f0, roughness, cosine);
        double sum = 0;
        for (uint32_t i = 0; i < kDirections; ++i)
          sum += double(respond(l, scene::cosineDirection(kNormal, scene::streamSequence(7, i))));
        EXPECT_NEAR(sum / kDirections, 1, 0.015) << f0 << " " << roughness << " " << cosine;
      }
}

// A normal map bends the normal by which light counts. Of an even light what is beneath the surface is lost, and up to
// 0.04 because of the bound on what the least cosines may count.
TEST(ReceiverLobe, AddsUpToOneAroundABentNormal) {
  for (const float tilt : {0.15f, 0.4f})
    for (const float roughness : {0.4f, 0.7f, 1.0f})
      for (const float cosine : {0.3f, 0.7f, 1.0f}) {
        const ReceiverLobe l = lobe(0.04f, roughness, cosine);
        const glm::vec3 flat = std::cos(tilt) * kNormal + std::sin(tilt) * toEye(0);
        double sum = 0, beneath = 0;
        for (uint32_t i = 0; i < kDirections; ++i) {
          const glm::vec2 u = scene::streamSequence(7, i);
          const glm::vec3 direction = scene::cosineDirection(flat, u),
                          bent = scene::cosineDirection(kNormal, u);
          sum += double(l.response(direction, glm::dot(flat, direction)));
          beneath += glm::dot(flat, bent) < 0 ? double(respond(l, bent)) : 0;
        }
        EXPECT_NEAR((sum + beneath) / kDirections, 1, 0.05) << tilt << " " << roughness << " " << cosine;
      }
}

TEST(ReceiverLobe, IsThatOfTheMicrofacets) {
  const float roughness = 0.5f, cosine = 0.6f;
  const double alpha = double(roughness) * double(roughness);
  const glm::dvec3 n(kNormal), v(toEye(cosine));
  const double albedo = double(path_trace::AlbedoTable::schlick().at(cosine, roughness).ofMirror());
  const ReceiverLobe l = lobe(1e-4f, roughness, cosine);  // so little that none is scattered twice
  for (uint32_t i = 0; i < 50; ++i) {
    const glm::vec3 direction = scene::cosineDirection(kNormal, scene::streamSequence(3, i));
    const glm::dvec3 d(direction), h = glm::normalize(d + v);
    const double nh = glm::dot(n, h), nv = glm::dot(n, v), nl = glm::dot(n, d), a2 = alpha * alpha;
    const double density = a2 / (glm::pi<double>() * std::pow(nh * nh * (a2 - 1) + 1, 2));
    const auto smith = [&](double c) { return std::sqrt(a2 + (1 - a2) * c * c); };
    const double want = glm::pi<double>() * density * 0.5 / (nl * smith(nv) + nv * smith(nl)) / albedo;
    EXPECT_NEAR(respond(l, direction), want, 2e-3 * want) << i;
  }
}

// A white metal, whose microfacets scatter everything in the end.
TEST(ReceiverLobe, HasWhatIsScatteredMoreThanOnce) {
  path_trace::BsdfParameters white = bsdfParameters(glm::vec3(1), 1, 1);
  for (const float cosine : {0.2f, 0.6f, 1.0f}) {
    const glm::mat3 frame = path_trace::frameAround(kNormal);
    const path_trace::Bsdf bsdf(white, path_trace::toLocal(frame, toEye(cosine)));
    const ReceiverLobe l = lobe(1, 1, cosine);
    for (uint32_t i = 0; i < 50; ++i) {
      const glm::vec3 direction = scene::cosineDirection(kNormal, scene::streamSequence(3, i));
      const double want = glm::pi<double>() * double(bsdf.evaluate(path_trace::toLocal(frame, direction)).x) /
                          double(glm::dot(kNormal, direction));
      EXPECT_NEAR(respond(l, direction), want, 0.01 * want) << cosine << " " << i;
    }
  }
}

TEST(ReceiverLobe, IsNoSmootherThanWhatIsTraced) {
  const glm::vec3 direction = glm::reflect(-toEye(0.7f), kNormal);
  EXPECT_EQ(respond(lobe(0.04f, 0.05f, 0.7f), direction), respond(lobe(0.04f, 0.3f, 0.7f), direction));
  EXPECT_EQ(respond(lobe(0.9f, 0.05f, 0.7f), direction), respond(lobe(0.9f, 0.7f, 0.7f), direction));
  EXPECT_GT(respond(lobe(0.04f, 0.3f, 0.7f), direction), respond(lobe(0.04f, 0.4f, 0.7f), direction));
}

TEST(ReceiverLobe, LightFromBehindAddsNothing) { EXPECT_EQ(respond(lobe(0.04f, 0.5f, 0.7f), -kNormal), 0); }

TEST(ReceiverLobe, WithoutOneLightIsThatOfTheDiffuseLayer) {
  for (const glm::vec3 direction : {kNormal, -kNormal, toEye(0.2f)}) {
    EXPECT_EQ(respond(ReceiverLobe(), direction), 1);
    EXPECT_EQ(respond(lobe(0, 0.5f, 0.7f), direction), 1);
  }
}

}  // namespace
}  // namespace fovea::test
