// Tests the conversion of irradiance to radiance, pixel by pixel.
#include <gtest/gtest.h>

#include "tests/passes/full_materials_reference.h"

namespace fovea::test {
namespace {

constexpr int kWidth = 5, kHeight = 3;

glm::vec3 albedoAt(int i) { return glm::vec3(i % 3, i % 4, i % 5) / 8.0f; }
glm::vec3 irradianceAt(int i) { return i == 7 ? glm::vec3(60000) : glm::vec3(i, 2 * i, 0.5f * float(i)); }
glm::vec3 directAt(int i) { return i == 7 ? glm::vec3(60000) : glm::vec3(3, float(i), 0); }

std::vector<uint16_t> image(glm::vec3 (*value)(int)) {
  std::vector<uint16_t> half;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    for (int c = 0; c < 3; ++c) half.push_back(glm::packHalf1x16(value(i)[c]));
    half.push_back(glm::packHalf1x16(1));
  }
  return half;
}

void compose(bool withDirect) {
  PassTest test("compose");
  test.viewSize(kWidth, kHeight);
  const auto input = [&](const char* port, glm::vec3 (*value)(int)) {
    test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image(value));
  };
  GBuffer(kWidth, kHeight, [](int x, int y) {
    SurfacePixel p;
    p.albedo = albedoAt(y * kWidth + x);
    return p;
  }).wire(test);
  input("irradiance", irradianceAt);
  if (withDirect) input("direct", directAt);
  test.run();
  const auto indirect = test.floats("indirect"), radiance = test.floats("radiance");
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const glm::vec3 reflected = albedoAt(i) * irradianceAt(i);
    const glm::vec3 all = glm::min(reflected + (withDirect ? directAt(i) : glm::vec3(0)), 65504.0f);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(indirect[size_t(4 * i + c)], reflected[c], 1e-3f * reflected[c]) << i;
      EXPECT_NEAR(radiance[size_t(4 * i + c)], all[c], 1e-3f * all[c]) << i;
    }
  }
}

// Where there is no light under the lobe, the irradiance stands in for it.
TEST(Compose, GlossySurfacesReflectOnTopOfTheirDiffuseLayer) {
  const path_trace::BsdfParameters material = bsdfParameters({0.8f, 0.5f, 0.2f}, 0.5f, 0.4f);
  const glm::vec3 eye(0, 2, 1);
  GBuffer g(kWidth, kHeight, raysOnto(eye, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}), [&](int x, int y) {
    SurfacePixel p;
    p.position = {float(x), 0, float(y)};
    p.distance = 1;
    setMaterial(p, material, glm::normalize(eye - p.position).y);
    return p;
  });
  g.full = true;
  for (const bool wired : {false, true}) {
    PassTest test("compose");
    g.wire(test);
    scene::Scene s;
    s.materials.emplace_back();
    s.cameras.emplace_back();
    s.cameras[0].position = eye;
    test.scene(s).view("materials", "full");
    test.image("irradiance", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image(directAt));
    if (wired) test.image("gloss", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image(albedoAt));
    test.run();
    const auto radiance = test.floats("radiance");
    for (int i = 0; i < kWidth * kHeight; ++i) {
      if (i == 7) continue;  // beyond what a half holds
      const SurfacePixel& p = g.pixels[size_t(i)];
      const float cosine = glm::normalize(eye - p.position).y;
      const glm::dvec3 reflects =
          glm::mix(dielectricAlbedo(material, cosine), metalAlbedo(material, cosine), 0.5);
      const glm::dvec3 want = glm::dvec3(p.albedo) * glm::dvec3(directAt(i)) +
                              reflects * glm::dvec3(wired ? albedoAt(i) : directAt(i));
      // A mixture of metal and dielectric has one curve for both.
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[size_t(4 * i + c)], want[c], 0.01 * want[c]) << i;
    }
  }
}

// For metals the light passes over from rays to VPLs between the roughness 0.7 and 0.85.
TEST(Compose, SmoothSurfacesReflectWhatRaysFind) {
  for (const auto& [roughness, share] : {std::pair(0.1f, 1.0), {0.76f, 0.6}, {0.9f, 0.0}}) {
    const path_trace::BsdfParameters metal = bsdfParameters(glm::vec3(0.9f), 1, roughness);
    GBuffer g(kWidth, kHeight, raysOnto({0, 1000, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}), [&](int x, int y) {
      SurfacePixel p;
      p.position = {float(x), 0, float(y)};
      p.distance = 1;
      setMaterial(p, metal, 1);
      return p;
    });
    g.full = true;
    PassTest test("compose");
    g.wire(test);
    scene::Scene s;
    s.materials.emplace_back();
    s.cameras.emplace_back();
    s.cameras[0].position = {0, 1000, 0};
    test.scene(s).view("materials", "full");
    std::vector<uint16_t> traced = image(directAt);
    traced[4 * 4 + 3] = 0;  // a pixel without a ray
    test.image("irradiance", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image(irradianceAt));
    test.image("gloss", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image(albedoAt));
    test.image("reflections", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, traced);
    test.run();
    const auto radiance = test.floats("radiance");
    const double reflects = metalAlbedo(metal, 1).r;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      if (i == 7) continue;  // beyond what a half holds
      for (int c = 0; c < 3; ++c) {
        const double want =
            reflects * glm::mix(double(albedoAt(i)[c]), double(directAt(i)[c]), i == 4 ? 0.0 : share);
        EXPECT_NEAR(radiance[size_t(4 * i + c)], want, 0.01 * want + 1e-4)
            << i << ", roughness " << roughness;
      }
    }
  }
}

// With diffuse materials nothing needs the light under lobes, so that what makes it does not run.
TEST(Compose, DiffuseSurfacesAskForNoReflections) {
  PassTest test("compose");
  test.viewSize(kWidth, kHeight);
  GBuffer(kWidth, kHeight, [](int, int) { return SurfacePixel{}; }).wire(test);
  for (const char* port : {"irradiance", "reflections", "gloss"})
    test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image(albedoAt));
  test.run();
  const auto radiance = test.floats("radiance");
  for (int i = 0; i < kWidth * kHeight; ++i)
    EXPECT_NEAR(radiance[size_t(4 * i)], 0.5f * albedoAt(i).r, 1e-3f) << i;
}

TEST(Compose, IrradianceTimesReflectance) { compose(false); }
TEST(Compose, DirectLightAddedUpToWhatAHalfHolds) { compose(true); }

}  // namespace
}  // namespace fovea::test
