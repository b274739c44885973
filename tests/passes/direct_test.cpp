#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "fovea/error.h"
#include "fovea/test.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"
#include "tests/passes/full_materials_reference.h"
#include "tests/passes/shadow_view.h"
#include "tests/support/pixel_rays.h"

namespace fovea::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;  // receivers
constexpr int kSize = 256;                // texels of a shadow map
const glm::vec3 kEye(0.4f, 1.7f, 0.9f);
constexpr float kExtent = 2;  // receivers cover [-2, 2] x [-2, 2] of the plane y = 0

const glm::vec3 kAlbedo(0.5f, 0.25f, 0.75f), kEmission(0.0625f, 0, 0.125f);
const glm::vec3 kSphereCentre(0.1f, 0.7f, -0.1f);
constexpr float kSphereRadius = 0.4f;

glm::vec3 receiver(int x, int y) {
  return {kExtent * (2 * (x + 0.5f) / kWidth - 1), 0, kExtent * (2 * (y + 0.5f) / kHeight - 1)};
}

std::vector<uint16_t> halves(const std::vector<float>& values) {
  std::vector<uint16_t> packed;
  for (const float v : values) packed.push_back(glm::packHalf1x16(v));
  return packed;
}

std::vector<int16_t> snorms(const std::vector<float>& values) {
  std::vector<int16_t> packed;
  for (const float v : values) packed.push_back(int16_t(std::lround(32767 * v)));
  return packed;
}

scene::Scene lit(std::vector<scene::Light> lights) {
  scene::Scene s;
  s.materials.emplace_back();
  s.cameras.emplace_back();
  s.cameras[0].position = kEye;
  s.lights = std::move(lights);
  return s;
}

scene::Light sun(glm::vec3 direction) {
  scene::Light light;
  light.direction = glm::normalize(direction);
  light.color = {1, 0.5f, 0.25f};
  light.intensity = 3;
  return light;
}

scene::Light point(glm::vec3 position) {
  scene::Light light = sun({0, -1, 0});
  light.type = scene::LightType::Point;
  light.position = position;
  light.intensity = 8;
  return light;
}

scene::Light spot(glm::vec3 position, glm::vec3 direction) {
  scene::Light light = point(position);
  light.type = scene::LightType::Spot;
  light.direction = glm::normalize(direction);
  light.innerConeAngle = 0.3f;
  light.outerConeAngle = 0.8f;
  return light;
}

// Irradiance of the plane y = 0 at p by the formulas of KHR_lights_punctual (passes/paper.md, light units).
glm::dvec3 irradiance(const scene::Light& light, glm::dvec3 p) {
  const glm::dvec3 power = glm::dvec3(light.color) * double(light.intensity);
  if (light.type == scene::LightType::Directional) return power * std::max(-double(light.direction.y), 0.0);
  const glm::dvec3 to = glm::dvec3(light.position) - p;
  const double d = glm::length(to);
  double factor = to.y / d / (d * d);
  if (light.range > 0) factor *= std::clamp(1 - std::pow(d / light.range, 4), 0.0, 1.0);
  if (light.type == scene::LightType::Spot) {
    const double cosine = -glm::dot(to, glm::dvec3(light.direction)) / d;
    const double inner = std::cos(double(light.innerConeAngle)),
                 outer = std::cos(double(light.outerConeAngle));
    const double f = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    factor *= f * f;
  }
  return power * factor;
}

std::vector<ShadowView> shadowViews(const std::vector<scene::Light>& lights) {
  std::vector<ShadowView> views;
  for (const scene::Light& light : lights) {
    if (light.type == scene::LightType::Directional) {
      views.push_back(orthographicView({0, 0, 0}, light.direction, 3, kSize));
    } else if (light.type == scene::LightType::Spot) {
      views.push_back(perspectiveView(light.position, light.direction, std::tan(light.outerConeAngle) * 1.05f,
                                      0.01f, kSize));
    } else {
      for (int face = 0; face < 6; ++face) {
        glm::vec3 axis(0);
        axis[face / 2] = face % 2 ? -1 : 1;
        views.push_back(perspectiveView(light.position, axis, 1.05f, 0.01f, kSize));
      }
    }
  }
  views.resize(kMaxShadowLayers);
  return views;
}

uint32_t layerCount(const std::vector<scene::Light>& lights) {
  uint32_t layers = 0;
  for (const scene::Light& light : lights) layers += light.type == scene::LightType::Point ? 6 : 1;
  return std::max(layers, 1u);
}

// Nearest hit of sphere and plane along a ray; distance in lengths of the direction, negative if there is none.
double nearest(glm::dvec3 origin, glm::dvec3 direction) {
  double best = -1;
  if (direction.y < 0 && origin.y > 0) best = -origin.y / direction.y;
  const glm::dvec3 c = origin - glm::dvec3(kSphereCentre);
  const double a = glm::dot(direction, direction), b = glm::dot(c, direction);
  const double discriminant = b * b - a * (glm::dot(c, c) - double(kSphereRadius) * kSphereRadius);
  if (discriminant > 0) {
    const double t = (-b - std::sqrt(discriminant)) / a;
    if (t > 0 && (best < 0 || t < best)) best = t;
  }
  return best;
}

// Depth of sphere and plane through the centre of every texel, by rays.
std::vector<float> shadowDepth(const std::vector<ShadowView>& views, uint32_t layers) {
  std::vector<float> depth;
  for (uint32_t layer = 0; layer < layers; ++layer) {
    const glm::dmat4 worldToClip(views[layer].worldToClip), clipToWorld = glm::inverse(worldToClip);
    auto unproject = [&](double x, double y, double z) {
      const glm::dvec4 p = clipToWorld * glm::dvec4(2 * x / kSize - 1, 2 * y / kSize - 1, z, 1);
      return glm::dvec3(p) / p.w;
    };
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const glm::dvec3 origin = unproject(x + 0.5, y + 0.5, 1);
        const glm::dvec3 direction = unproject(x + 0.5, y + 0.5, 0.5) - origin;
        const double t = nearest(origin, direction);
        if (t < 0) {
          depth.push_back(0);
          continue;
        }
        const glm::dvec4 p = worldToClip * glm::dvec4(origin + t * direction, 1);
        depth.push_back(float(p.z / p.w));
      }
  }
  return depth;
}

struct Surface {
  glm::vec3 normal{0, 1, 0};
  glm::vec2 face{0, 1};                                  // octahedral (0, 1, 0)
  float distance = 5;                                    // 0 in the background
  const path_trace::BsdfParameters* material = nullptr;  // if it is full
};

// Direct radiance, RGBA, of the plane of receivers.
std::vector<float> shade(const std::vector<scene::Light>& lights, const std::vector<ShadowView>& views,
                         const std::vector<float>& depth, const char* filter, const Surface& surface = {}) {
  std::vector<glm::vec4> position;
  std::vector<float> normal, face, albedo, emission, specular;
  const bool full = surface.material != nullptr;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::vec3 p = receiver(x, y);
      position.emplace_back(p, surface.distance);
      SurfacePixel pixel;
      pixel.albedo = kAlbedo;
      const float dielectric = full ? surface.material->specularF0.g : 0;
      if (full) setMaterial(pixel, *surface.material, glm::normalize(kEye - p).y);
      normal.insert(normal.end(), {surface.normal.x, surface.normal.y, surface.normal.z, pixel.grazing});
      face.insert(face.end(), {surface.face.x, surface.face.y});
      albedo.insert(albedo.end(), {pixel.albedo.r, pixel.albedo.g, pixel.albedo.b, pixel.metallic});
      const glm::vec3 emitted = full ? glm::vec3(0) : kEmission;
      emission.insert(emission.end(), {emitted.r, emitted.g, emitted.b, dielectric});
      if (full || specular.empty())
        specular.insert(specular.end(),
                        {pixel.specular.r, pixel.specular.g, pixel.specular.b, pixel.specular.a});
    }
  PassTest test("direct");
  test.param("filter", filter).viewSize(kWidth, kHeight).scene(lit(lights));
  test.view("materials", full ? "full" : "diffuse");
  const glm::vec3 right(2 * kExtent / kWidth, 0, 0), down(0, 0, 2 * kExtent / kHeight);
  wireSurfaces(test, "gbuffer", raysOnto({0, 5, 0}, receiver(0, 0), right, down), kWidth, kHeight, position);
  test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, halves(normal));
  test.image("gbuffer.face", VK_FORMAT_R16G16_SNORM, kWidth, kHeight, 1, snorms(face));
  test.image("gbuffer.albedo", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, halves(albedo));
  test.image("gbuffer.emission", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, halves(emission));
  test.image("gbuffer.specular", VK_FORMAT_R16G16B16A16_SFLOAT, full ? kWidth : 1, full ? kHeight : 1, 1,
             halves(specular));
  test.image("maps.depth", VK_FORMAT_D32_SFLOAT, kSize, kSize, layerCount(lights), depth);
  test.buffer("maps.views", views, "ShadowView");
  test.run();
  return test.floats("direct");
}

std::vector<float> shadeUnshadowed(const std::vector<scene::Light>& lights, const Surface& surface = {}) {
  return shade(lights, shadowViews(lights),
               std::vector<float>(size_t(kSize) * kSize * layerCount(lights), 0.0f), "pcf", surface);
}

// visibility(light, x, y) is in [0, 1], or negative to leave this pixel out. Returns the number of pixels compared.
int expectRadiance(const std::vector<float>& got, const std::vector<scene::Light>& lights,
                   const std::function<double(const scene::Light&, glm::dvec3)>& visibility) {
  int compared = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 p(receiver(x, y));
      glm::dvec3 e(0);
      bool skip = false;
      for (const scene::Light& light : lights) {
        const double v = visibility(light, p);
        skip |= v < 0;
        e += v * irradiance(light, p);
      }
      if (skip) continue;
      ++compared;
      const glm::dvec3 want = glm::dvec3(kEmission) + glm::dvec3(kAlbedo) / glm::pi<double>() * e;
      for (int c = 0; c < 3; ++c) {
        const double value = got[4 * (size_t(y) * kWidth + x) + c];
        // Half floats resolve 1/2048.
        if (std::abs(value - want[c]) <= 1e-3 * want[c] + 1e-5) continue;
        ADD_FAILURE() << "pixel " << x << ", " << y << ", channel " << c << ": " << value << ", not "
                      << want[c];
        return 0;
      }
    }
  return compared;
}

double always(const scene::Light&, glm::dvec3) { return 1; }

TEST(Direct, EachLightTypeEqualsTheClosedForm) {
  scene::Light ranged = point({0.2f, 0.7f, 0.1f});
  ranged.range = 1.5f;
  for (const scene::Light& light : {sun({0.3f, -1, 0.6f}), sun({0, 1, 0}), point({0.4f, 1.5f, -0.3f}), ranged,
                                    spot({-0.5f, 2, 0.5f}, {0.4f, -1, 0}), spot({0, 1, 0}, {0, -1, 0})}) {
    SCOPED_TRACE(int(light.type));
    EXPECT_EQ(expectRadiance(shadeUnshadowed({light}), {light}, always), kWidth * kHeight);
  }
}

TEST(Direct, LightsAddUp) {
  const std::vector<scene::Light> lights = {point({1, 1, 1}), sun({0.3f, -1, 0}),
                                            spot({-1, 2, 0}, {0, -1, 0}), point({-1, 0.5f, -1})};
  EXPECT_EQ(expectRadiance(shadeUnshadowed(lights), lights, always), kWidth * kHeight);
}

TEST(Direct, WithoutLightOnlyEmission) {
  EXPECT_EQ(expectRadiance(shadeUnshadowed({}), {}, always), kWidth * kHeight);
}

TEST(Direct, BackgroundShowsTheEnvironment) {
  Surface background;
  background.distance = 0;
  EXPECT_EQ(expectRadiance(shadeUnshadowed({sun({0, -1, 0})}, background), {}, always), kWidth * kHeight);
}

// The interpolated normal leans towards the light, but the face itself is turned away from it.
TEST(Direct, FaceTurnedAwayIsDark) {
  Surface terminator;
  terminator.normal = glm::normalize(glm::vec3(0.9f, 0.5f, 0));
  EXPECT_EQ(expectRadiance(shadeUnshadowed({sun({-1, 0.1f, 0})}, terminator), {}, always), kWidth * kHeight);
}

// ---- Full materials -------------------------------------------------------------------------------------------------

// Metals, dielectrics and what is between, smooth and rough.
std::vector<path_trace::BsdfParameters> fullMaterials() {
  std::vector<path_trace::BsdfParameters> list;
  for (const float roughness : {0.25f, 0.5f, 0.8f, 1.0f})
    for (const float metallic : {0.0f, 0.4f, 1.0f})
      list.push_back(bsdfParameters({0.9f, 0.5f, 0.2f}, metallic, roughness));
  list.push_back(bsdfParameters(glm::vec3(0.5f), 0, 0.3f));
  list.back().specularF0 = glm::vec3(0.02f);
  list.back().specularF90 = 0.5f;
  list.push_back(bsdfParameters(glm::vec3(0.8f), 0, 0.4f));
  list.back().transmission = 0.6f;
  return list;
}

TEST(DirectFull, EachLightTypeEqualsTheBsdf) {
  for (const scene::Light& light : {sun({0.3f, -1, 0.6f}), sun({-1, -0.3f, 0.2f}), point({0.4f, 1.5f, -0.3f}),
                                    spot({-0.5f, 2, 0.5f}, {0.4f, -1, 0})})
    for (const path_trace::BsdfParameters& material : fullMaterials()) {
      SCOPED_TRACE(testing::Message() << "light type " << int(light.type) << ", roughness "
                                      << material.roughness << ", metallic " << material.metallic);
      Surface surface;
      surface.material = &material;
      const std::vector<float> got = shadeUnshadowed({light}, surface);
      const glm::mat3 frame = path_trace::frameAround({0, 1, 0});
      double squares = 0, all = 0, most = 0;
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const glm::vec3 p = receiver(i % kWidth, i / kWidth);
        const path_trace::Bsdf bsdf(material, path_trace::toLocal(frame, glm::normalize(kEye - p)));
        const path_trace::IncidentLight l = path_trace::incidentLight(light, p);
        for (int c = 0; c < 3; ++c) {
          const double want = double(l.irradiance[c] *
                                     bsdf.evaluate(path_trace::toLocal(frame, l.direction))[c]),
                       value = double(got[4 * size_t(i) + size_t(c)]);
          // Dielectrics have a polynomial for Fresnel's equations, and mixtures one curve for both of their parts.
          most = std::max(most, std::abs(value - want) / (want + 1e-3));
          squares += (value - want) * (value - want);
          all += want * want;
        }
      }
      EXPECT_LT(most, 0.05);
      EXPECT_LT(std::sqrt(squares / all), 0.012);
    }
}

TEST(DirectFull, TheGBufferHasToBeFullAsWell) {
  PassTest test("direct");
  test.view("materials", "full").viewSize(8, 8).scene(lit({sun({0, -1, 0})}));
  GBuffer(8, 8, [](int, int) { return SurfacePixel{}; }).wire(test);
  test.image("gbuffer.emission", VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, 1, std::vector<uint16_t>(256));
  test.image("maps.depth", VK_FORMAT_D32_SFLOAT, 8, 8, 1, std::vector<float>(64));
  test.buffer("maps.views", std::vector<ShadowView>(kMaxShadowLayers), "ShadowView");
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("those of the G-buffer are not"), std::string::npos) << e.what();
  }
}

// ---- Shadows --------------------------------------------------------------------------------------------------------

// Whether the sphere stands between p and the light; -1 if p is too close to the rim of its shadow for a map
// of this resolution.
double sphereVisibility(const scene::Light& light, glm::dvec3 p) {
  const bool directional = light.type == scene::LightType::Directional;
  const glm::dvec3 to = directional ? -glm::dvec3(light.direction) : glm::dvec3(light.position) - p;
  const double distance = directional ? 10 : glm::length(to);
  // Texel at the receiver; a cube face or cone sees texels up to 1.73 times as wide along the ray.
  const double texel = directional ? 6.0 / kSize : 2 * 1.09 * 1.73 * distance / kSize;
  const glm::dvec3 d = glm::normalize(to), c = glm::dvec3(kSphereCentre) - p;
  const double along = glm::dot(c, d);
  const double off = glm::length(c - along * d) - kSphereRadius;
  if (std::abs(off) < 3 * texel) return -1;  // reach of the filter
  return off < 0 && along > 0 && along < distance ? 0 : 1;
}

void expectShadows(const std::vector<scene::Light>& lights, int atLeast) {
  const auto views = shadowViews(lights);
  const auto depth = shadowDepth(views, layerCount(lights));
  for (const char* filter : {"none", "bilinear", "pcf"}) {
    SCOPED_TRACE(filter);
    EXPECT_GT(expectRadiance(shade(lights, views, depth, filter), lights, sphereVisibility), atLeast);
  }
}

TEST(Direct, ShadowOfASphereEqualsRays) {
  int shadowed = 0;
  const scene::Light light = sun({0.5f, -1, 0.2f});
  for (int i = 0; i < kWidth * kHeight; ++i)
    shadowed += sphereVisibility(light, glm::dvec3(receiver(i % kWidth, i / kWidth))) == 0;
  EXPECT_GT(shadowed, 20);  // the test is not vacuous
  expectShadows({light}, kWidth * kHeight / 2);
  expectShadows({point({0.3f, 2.5f, 0.2f})}, kWidth * kHeight / 2);
  expectShadows({spot({-0.8f, 2.2f, 0.5f}, {0.4f, -1, -0.3f})}, kWidth * kHeight / 2);
  expectShadows(
      {point({0.3f, 2.5f, 0.2f}), sun({0.5f, -1, 0.2f}), spot({-0.8f, 2.2f, 0.5f}, {0.4f, -1, -0.3f})},
      kWidth * kHeight / 4);
}

// Light that just grazes the plane: its slope in the map is between 1 and 11, so any fixed bias would fail.
TEST(Direct, NoAcneAtGrazingLight) {
  expectShadows({sun({1, -0.09f, 0.3f})}, kWidth * kHeight / 3);
  expectShadows({point({1.5f, 0.15f, 1.2f})}, kWidth * kHeight / 3);
}

TEST(Direct, FilterSoftensTheRim) {
  const std::vector<scene::Light> lights = {sun({0.5f, -1, 0.2f})};
  const auto views = shadowViews(lights);
  const auto depth = shadowDepth(views, 1);
  const double full = kEmission.r + kAlbedo.r / glm::pi<double>() * irradiance(lights[0], {}).r;
  auto between = [&](const char* filter) {
    int count = 0;
    const auto radiance = shade(lights, views, depth, filter);
    for (size_t i = 0; i < radiance.size(); i += 4)
      count += radiance[i] > kEmission.r * 1.01 && radiance[i] < full * 0.99;
    return count;
  };
  EXPECT_EQ(between("none"), 0);
  EXPECT_GT(between("bilinear"), 10);
  EXPECT_GT(between("pcf"), between("bilinear"));
}

// Alpha is 0 exactly where the map's texels disagree, which is the rim of the shadow.
TEST(Direct, TellsWhatIsInDoubt) {
  const std::vector<scene::Light> lights = {sun({0.5f, -1, 0.2f})};
  const auto views = shadowViews(lights);
  const auto depth = shadowDepth(views, 1);
  const double full = kEmission.r + kAlbedo.r / glm::pi<double>() * irradiance(lights[0], {}).r;
  const auto radiance = shade(lights, views, depth, "bilinear");
  int doubts = 0;
  for (size_t i = 0; i < radiance.size(); i += 4) {
    const bool between = radiance[i] > kEmission.r * 1.002 && radiance[i] < full * 0.998;
    const bool near = std::abs(radiance[i] - kEmission.r) < 0.01 || std::abs(radiance[i] - full) < 0.01;
    doubts += radiance[i + 3] == 0;
    ASSERT_TRUE(radiance[i + 3] == 0 || radiance[i + 3] == 1);
    EXPECT_TRUE(!between || radiance[i + 3] == 0) << "pixel " << i / 4;
    EXPECT_TRUE(radiance[i + 3] == 1 || between || near) << "pixel " << i / 4;
  }
  EXPECT_GT(doubts, 10);
  EXPECT_LT(doubts, kWidth * kHeight / 10);
  const auto jagged = shade(lights, views, depth, "none");
  for (size_t i = 0; i < jagged.size(); i += 4) ASSERT_EQ(jagged[i + 3], 1);
}

}  // namespace
}  // namespace fovea::test
