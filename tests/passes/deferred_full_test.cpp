// Tests the light of VPLs that glossy surfaces reflect, in passes deferred and compose: against a plain sum on the CPU,
// at the bounds that it keeps, and in a white furnace.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "fovea/error.h"
#include "passes/path-trace/microfacets.h"
#include "tests/passes/deferred_scenes.h"
#include "tests/passes/full_materials_reference.h"

namespace fovea::test {
namespace {

using scene::Vpl;
constexpr double kPi = glm::pi<double>();
const glm::vec3 kEye(0.3f, 2, 1.5f);

// A floor of one material, seen from kEye.
GBuffer floorOf(const path_trace::BsdfParameters& material, int width = 24, int height = 20,
                float step = 0.1f) {
  const glm::vec3 first(-0.5f * float(width - 1) * step, 0, -0.5f * float(height - 1) * step);
  const scene::PixelRays rays = raysOnto(kEye, first, {step, 0, 0}, {0, 0, step});
  GBuffer g(width, height, rays, [&](int x, int y) {
    SurfacePixel p;
    p.position = {(float(x) - 0.5f * float(width - 1)) * step, 0,
                  (float(y) - 0.5f * float(height - 1)) * step};
    p.distance = glm::distance(p.position, kEye);
    setMaterial(p, material, glm::normalize(kEye - p.position).y);
    return p;
  });
  g.full = true;
  return g;
}

scene::Scene seenFrom(glm::vec3 eye) {
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  s.cameras[0].position = eye;
  return s;
}

struct Output {
  std::vector<float> irradiance, gloss, indirect;
};

// nearField, nearGloss: at all pixels; not wired if negative.
Output run(const GBuffer& g, const std::vector<Vpl>& vpls, int interleave, bool disc = true,
           float nearField = -1, float nearGloss = -1) {
  PassTest test("deferred");
  g.wire(test);
  for (const auto& [port, value] : {std::pair("near_field", nearField), {"near_gloss", nearGloss}})
    if (value >= 0)
      test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(g.width), uint32_t(g.height), 1,
                 std::vector<uint64_t>(g.pixels.size(), glm::packHalf4x16(glm::vec4(glm::vec3(value), 1))));
  test.scene(seenFrom(kEye)).view("materials", "full").param("kernel", disc ? "disc" : "clamp");
  test.buffer("vpls", vpls, "Vpl").param("interleave", interleave);
  test.run();
  return {test.floats("irradiance"), test.floats("gloss"), test.floats("indirect")};
}

double mirrorAlbedo(const SurfacePixel& p) {
  const double cosine = glm::dot(glm::dvec3(p.normal), glm::normalize(glm::dvec3(kEye - p.position)));
  return double(path_trace::AlbedoTable::schlick().at(float(cosine), p.specular.a).ofMirror());
}

// The mean of the light under the lobe: GGX, widened by the solid angle of each disc.
glm::dvec3 underLobe(const SurfacePixel& p, const std::vector<Vpl>& vpls, bool disc) {
  const glm::dvec3 n(p.normal), v = glm::normalize(glm::dvec3(kEye - p.position));
  const double nv = glm::dot(n, v), alpha = double(path_trace::ggxWidth(p.specular.a));
  glm::dvec3 sum(0);
  for (const Vpl& vpl : vpls) {
    const glm::dvec3 to(vpl.position - p.position);
    const double d2 = glm::dot(to, to), area = double(vpl.area);
    const glm::dvec3 l = to / std::sqrt(d2), h = glm::normalize(l + v);
    const double nl = std::max(glm::dot(n, l), 0.0),
                 out = std::max(-glm::dot(glm::dvec3(vpl.normal), l), 0.0);
    const double facing = glm::dot(h, l), nh = glm::dot(n, h);
    const double a2 = std::min(alpha * alpha + area / (4 * (kPi * d2 + area) * facing * facing), 1.0);
    const double ndf = a2 / (kPi * std::pow(nh * nh * (a2 - 1) + 1, 2));
    const auto smith = [&](double c) { return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); };
    const double masking = 0.5 / (nl * smith(nv) + nv * smith(nl));
    const double kernel = disc ? 1 / (d2 + area / kPi) : 1 / std::max(d2, 2.25);
    sum += glm::dvec3(vpl.intensity) * (nl * out * kernel * ndf * masking);
  }
  return sum / mirrorAlbedo(p);
}

// How much of it is used; the rest is the light of the diffuse layer.
double shareOf(const SurfacePixel& p) {
  const bool metal = std::max({p.specular.r, p.specular.g, p.specular.b}) > 0.15f;
  return metal ? 1 : std::clamp((0.6 - double(p.specular.a)) / 0.15, 0.0, 1.0);
}

TEST(DeferredFull, EqualsTheSumOnTheCpu) {
  const auto vpls = randomVpls(150);
  for (const bool disc : {true, false})
    for (const path_trace::BsdfParameters& material :
         {bsdfParameters({0.9f, 0.6f, 0.3f}, 1, 0.1f), bsdfParameters({0.9f, 0.6f, 0.3f}, 1, 0.9f),
          bsdfParameters({0.5f, 0.4f, 0.3f}, 0, 0.3f), bsdfParameters({0.5f, 0.4f, 0.3f}, 0, 0.5f),
          bsdfParameters({0.5f, 0.4f, 0.3f}, 0, 0.8f)}) {
      SCOPED_TRACE(testing::Message() << material.metallic << " " << material.roughness << " " << disc);
      const GBuffer g = floorOf(material);
      const Output out = run(g, vpls, 1, disc);
      for (size_t i = 0; i < g.pixels.size(); ++i) {
        const SurfacePixel& p = g.pixels[i];
        const glm::dvec3 lobe = underLobe(p, vpls, disc), share(shareOf(p));
        for (int c = 0; c < 3; ++c) {
          const double light = double(out.irradiance[4 * i + size_t(c)]),
                       want = glm::mix(light, lobe[c], share[c]),
                       gloss = double(out.gloss[4 * i + size_t(c)]);
          ASSERT_NEAR(gloss, want, 0.01 * want + 1e-4) << i;
          // What the surface reflects of it comes on top of the diffuse layer.
          const float cosine = glm::normalize(kEye - p.position).y;
          const double reflects = glm::mix(dielectricAlbedo(material, cosine), metalAlbedo(material, cosine),
                                           glm::dvec3(material.metallic))[c];
          const double total = double(p.albedo[c]) * light + reflects * gloss;
          ASSERT_NEAR(out.indirect[4 * i + size_t(c)], total, 0.01 * total + 1e-4) << i;
        }
      }
    }
}

// Fresnel's reflection leaves the layer less at grazing angles than its mean over all, unless F90 is 0. Metals have no
// such layer, and their irradiance, which stands in for the light under their lobe in the second eye, is as it is.
TEST(DeferredFull, DiffuseLayersGetWhatTheSurfaceLetsThrough) {
  for (const float roughness : {0.05f, 0.2f, 0.3f, 0.45f})
    for (const float f90 : {1.0f, 0.0f})
      for (const float metallic : {0.0f, 1.0f})
        for (const float cosine : {0.1f, 0.25f, 0.5f, 1.0f}) {
          path_trace::BsdfParameters material = bsdfParameters({0.5f, 0.4f, 0.3f}, metallic, roughness);
          material.specularF90 = f90;
          material.specularF0 = 0.04f * glm::vec3(f90);
          SurfacePixel p;
          p.distance = glm::distance(p.position, kEye);
          setMaterial(p, material, glm::normalize(kEye).y);
          GBuffer g(8, 8, raysOnto(kEye, p.position, glm::vec3(0), glm::vec3(0)),
                    [&](int, int) { return p; });
          g.full = true;
          const glm::vec3 direction(std::sqrt(1 - cosine * cosine), cosine, 0);
          const auto vpls = std::vector{makeVpl(10.0f * direction, -direction, glm::vec3(1e4f), 1e-3f)};
          const double diffuse = double(cosine) * 1e4 / (100 + 1e-3 / kPi) / kPi;
          const double enters = 1 - dielectricAlbedo(material, cosine).r,
                       average = 1 - dielectricAlbedo(material).r;
          const double want = metallic > 0 ? 1 : enters / average;
          EXPECT_NEAR(double(run(g, vpls, 1).irradiance[0]) / diffuse, want, metallic > 0 ? 0.01 : 0.06)
              << roughness << " " << f90 << " " << metallic << " " << cosine;
        }
}

// What rays have found under the lobe of a surface of any roughness comes on top of what VPLs have. Without it, what
// they have found of its irradiance does.
TEST(DeferredFull, AddsTheNearFieldUnderTheLobe) {
  const auto vpls = randomVpls(50);
  for (const float metallic : {0.0f, 1.0f})
    for (const float roughness : {0.2f, 0.5f, 0.8f}) {
      const GBuffer g = floorOf(bsdfParameters(glm::vec3(0.5f), metallic, roughness));
      const Output none = run(g, vpls, 1), one = run(g, vpls, 1, true, 3), both = run(g, vpls, 1, true, 3, 7);
      for (size_t i = 0; i < none.gloss.size(); ++i) {
        if (i % 4 == 3) continue;
        const auto near = [&](const std::vector<float>& with, const std::vector<float>& without,
                              float added) {
          ASSERT_NEAR(with[i], without[i] + added, 2e-3f * with[i])
              << metallic << " " << roughness << " " << i;
        };
        near(one.irradiance, none.irradiance, 3);
        near(both.irradiance, none.irradiance, 3);
        near(one.gloss, none.gloss, 3);
        near(both.gloss, none.gloss, 7);
      }
    }
}

TEST(DeferredFull, RefusesAPartOfTheNearFieldAlone) {
  const GBuffer g = floorOf(bsdfParameters(glm::vec3(0.5f), 0, 0.5f));
  try {
    run(g, randomVpls(50), 1, true, -1, 7);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("`near_gloss` is wired without"), std::string::npos) << e.what();
  }
}

// More VPLs than one page holds.
TEST(DeferredFull, PagesAddUp) {
  const GBuffer g = floorOf(bsdfParameters(glm::vec3(0.5f), 0, 0.5f));
  const auto vpls = randomVpls(2500);
  const Output out = run(g, vpls, 1, true, 3, 7);
  for (size_t i = 0; i < g.pixels.size(); ++i) {
    const glm::dvec3 lobe = underLobe(g.pixels[i], vpls, true);
    for (int c = 0; c < 3; ++c) {
      const double light = double(out.irradiance[4 * i + size_t(c)]) - 3;
      const double want = 7 + glm::mix(light, lobe[c], shareOf(g.pixels[i]));
      ASSERT_NEAR(out.gloss[4 * i + size_t(c)], want, 0.01 * want) << i;
    }
  }
}

// All pixels of a block see the same sum in the end, and interleaving only mixes neighbours.
TEST(DeferredFull, InterleavingKeepsTheLight) {
  const auto vpls = randomVpls(400);
  const GBuffer g = floorOf(bsdfParameters({0.9f, 0.6f, 0.3f}, 1, 0.4f), 48, 40, 0.01f);
  const Output all = run(g, vpls, 1), four = run(g, vpls, 4);
  for (size_t i = 0; i < all.gloss.size(); ++i)
    ASSERT_NEAR(four.gloss[i], all.gloss[i], 0.04f * all.gloss[i]);
}

// A VPL is never brighter in a mirror than the disc of its area that it stands for, with radiance I / A, times what a
// lobe may gain at grazing angles.
TEST(DeferredFull, NoVplIsBrighterThanItsDisc) {
  const GBuffer g = floorOf(bsdfParameters(glm::vec3(1), 1, 0.02f), 40, 40, 0.05f);
  for (const float height : {0.02f, 0.2f, 1.0f, 3.0f})
    for (const float area : {0.01f, 0.3f, 4.0f}) {
      const Output out = run(g, {makeVpl({0.1f, height, -0.3f}, {0, -1, 0}, glm::vec3(area), area)}, 1);
      float most = 0;
      for (size_t i = 0; i < out.gloss.size(); i += 4) most = std::max(most, out.gloss[i]);
      EXPECT_LT(most, 1.3f) << height << " " << area;
      if (height > 0.5f && area < 1) {
        EXPECT_GT(most, 0.3f) << height << " " << area;
      }
    }
}

// VPLs all around, which together amount to a radiance of 1 from all directions: a white surface of any roughness sends
// as much to the eye. Lobes narrower than the distance of the VPLs see more or less of them from pixel to pixel, and
// the right amount on average.
TEST(DeferredFull, WhiteSurfacesVanishInAWhiteFurnace) {
  constexpr uint32_t kCount = 4096;
  constexpr double kRadius = 60;
  std::vector<Vpl> vpls;
  const double area = 2 * kPi * kRadius * kRadius / kCount;  // of a hemisphere
  for (uint32_t i = 0; i < kCount; ++i) {
    const double z = (i + 0.5) / kCount, phi = 2.399963 * i, r = std::sqrt(1 - z * z);
    const glm::vec3 d(glm::dvec3(r * std::cos(phi), z, r * std::sin(phi)));
    vpls.push_back(makeVpl(d * float(kRadius), -d, glm::vec3(float(area)), float(area)));
  }
  for (const float metallic : {0.0f, 0.5f, 1.0f})
    for (const float roughness : {0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 1.0f}) {
      const Output out = run(floorOf(bsdfParameters(glm::vec3(1), metallic, roughness)), vpls, 1);
      SCOPED_TRACE(testing::Message() << "metallic " << metallic << ", roughness " << roughness);
      double mean = 0;
      for (size_t i = 0; i < out.indirect.size(); i += 4) {
        mean += 4 * double(out.indirect[i]) / double(out.indirect.size());
        if (roughness >= 0.2f) {
          ASSERT_NEAR(out.indirect[i], 1, 0.01);
        }
      }
      EXPECT_NEAR(mean, 1, 0.01);
    }
}

TEST(DeferredFull, BackgroundIsBlack) {
  GBuffer g = floorOf(bsdfParameters(glm::vec3(1), 1, 0.3f));
  for (size_t i = 0; i < g.pixels.size(); i += 3) g.pixels[i] = SurfacePixel{};
  const Output out = run(g, randomVpls(100), 4);
  for (size_t i = 0; i < g.pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_TRUE(std::isfinite(out.gloss[4 * i + c]));
      if (i % 3 == 0) {
        ASSERT_EQ(out.gloss[4 * i + c], 0);
        ASSERT_EQ(out.indirect[4 * i + c], 0);
      } else {
        ASSERT_GT(out.gloss[4 * i + c], 0);
      }
    }
}

}  // namespace
}  // namespace fovea::test
