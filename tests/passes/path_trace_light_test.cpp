// Tests how the path tracer evaluates lights and chooses directions towards emissive triangles and the environment.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "framework/base/random.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/emitters.h"
#include "passes/path-trace/environment.h"
#include "passes/path-trace/lights.h"
#include "tests/support/shapes.h"
#include "tests/support/sky.h"

namespace fovea::path_trace {
namespace {

using namespace scene;
using test::addMaterial;
using test::addQuad;

float number(uint32_t i, uint32_t what) { return uniformFloat(randomStream(7, what, 0, i)); }

glm::vec3 unit(uint32_t i, uint32_t what) {
  const float z = 2 * number(i, what) - 1, phi = glm::two_pi<float>() * number(i, what + 1),
              across = std::sqrt(1 - z * z);
  return {across * std::cos(phi), across * std::sin(phi), z};
}

TEST(PathTraceDirections, FramesAreRightHandedAndOrthonormal) {
  for (uint32_t i = 0; i < 1000; ++i) {
    const glm::vec3 normal =
        i < 6 ? glm::vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2) * (i < 3 ? 1.0f : -1.0f) : unit(i, 0);
    const glm::mat3 frame = frameAround(normal);
    ASSERT_EQ(frame[2], normal);
    ASSERT_NEAR(glm::determinant(frame), 1, 1e-5f);
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) ASSERT_NEAR(glm::dot(frame[k], frame[l]), k == l, 1e-5f);
    const glm::vec3 d = unit(i, 2);
    ASSERT_LT(glm::distance(toWorld(frame, toLocal(frame, d)), d), 1e-5f);
    ASSERT_NEAR(toLocal(frame, d).z, glm::dot(d, normal), 1e-5f);
  }
}

// KHR_lights_punctual by hand.
TEST(PathTraceLights, FallOffAsTheExtensionSays) {
  Light light;
  light.color = {1, 0.5f, 0.25f};
  light.intensity = 8;
  light.direction = {0, -1, 0};
  IncidentLight l = incidentLight(light, {5, 6, 7});
  EXPECT_EQ(l.irradiance, glm::vec3(8, 4, 2));
  EXPECT_EQ(l.direction, glm::vec3(0, 1, 0));
  EXPECT_TRUE(std::isinf(l.distance));

  light.type = LightType::Point;
  light.position = {0, 2, 0};
  l = incidentLight(light, {0, 0, 0});
  EXPECT_EQ(l.irradiance, glm::vec3(2, 1, 0.5f));
  EXPECT_EQ(l.direction, glm::vec3(0, 1, 0));
  EXPECT_EQ(l.distance, 2);
  light.range = 4;
  EXPECT_NEAR(incidentLight(light, {0, 0, 0}).irradiance.r, 2 * (1 - 1 / 16.0f), 1e-6f);
  EXPECT_EQ(incidentLight(light, {0, -3, 0}).irradiance, glm::vec3(0));

  light.range = 0;
  light.type = LightType::Spot;
  light.innerConeAngle = 0.2f;
  light.outerConeAngle = 0.6f;
  for (const float angle : {0.0f, 0.19f, 0.3f, 0.5f, 0.61f, 2.0f}) {
    l = incidentLight(light, light.position + glm::vec3(2 * std::sin(angle), -2 * std::cos(angle), 0));
    const float share = (std::cos(angle) - std::cos(0.6f)) / (std::cos(0.2f) - std::cos(0.6f)),
                cut = std::min(std::max(share, 0.0f), 1.0f);
    EXPECT_NEAR(l.irradiance.r, 2 * cut * cut, 1e-5f) << angle;
  }
}

struct Lit {
  Scene scene;
  Geometry geometry;
  Frame frame;

  explicit Lit(Scene s) : scene(std::move(s)) {
    scene.cameras.emplace_back();
    geometry = flatten(scene);
    frame = makeFrame(scene, geometry, glm::uvec2(16), 0, 1);
  }
};

// Panels in different places, of different size, power and orientation, among surfaces that are not emissive.
Scene panels(uint32_t count) {
  Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  addQuad(s, grey, {-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t m = addMaterial(s, glm::vec3(0.5f));
    s.materials[m].emission = glm::vec3(0.1f + 10 * number(i, 0), 1, 2);
    s.materials[m].doubleSided = i % 3 == 0;
    const auto vector = [&](uint32_t k) {
      return glm::vec3(number(i, k), number(i, k + 1), number(i, k + 2)) - 0.5f;
    };
    addQuad(s, m, 8.0f * vector(1), vector(4), vector(7));
  }
  return s;
}

// Each triangle is chosen as often as its density says, and points lie on the triangle.
TEST(PathTraceEmitters, DensityIsThatOfTheSamples) {
  for (const uint32_t count : {1u, 3u, 40u}) {
    const Lit lit(panels(count));
    const Emitters emitters(lit.frame);
    Receiver receiver{{0.3f, 0.4f, -0.2f}, {}};
    receiver.normal =
        glm::normalize(lit.geometry.positions[4] - receiver.position);  // towards the first panel
    std::map<uint32_t, double> chosen;
    constexpr int kSamples = 200000;
    for (uint32_t i = 0; i < kSamples; ++i) {
      const EmitterPoint p = emitters.sample(receiver, number(i, 20), number(i, 21), number(i, 22));
      if (!p.hit) continue;
      chosen[p.hit.triangle] += 1.0 / kSamples;
      ASSERT_NEAR(p.density, emitters.density(p.hit.triangle, receiver), 1e-4f * p.density);
      ASSERT_GT(glm::dot(p.normal, receiver.position - p.position), 0);
      ASSERT_LT(glm::distance(p.position, surfaceAt(lit.geometry, p.hit).position), 1e-5f);
      ASSERT_LE(p.hit.u + p.hit.v, 1.00001f);
    }
    double sum = 0;
    for (uint32_t t = 0; t < lit.geometry.triangles.size(); ++t) {
      const TriangleVertices v = triangleVertices(lit.geometry, t);
      const glm::vec3 edges = glm::cross(v.positions[1] - v.positions[0], v.positions[2] - v.positions[0]);
      const double want = 0.5 * double(glm::length(edges) * emitters.density(t, receiver));
      EXPECT_NEAR(chosen[t], want, 4.5 * std::sqrt(want / kSamples) + 1e-6) << t << " of " << count;
      sum += want;
    }
    EXPECT_LE(sum, 1.0001);
    EXPECT_GT(sum, 0.3);  // the rest are choices of groups that face away
  }
}

// Points are even over a triangle: the means of its weights are 1/3, and so are twice those of their squares.
TEST(PathTraceEmitters, PointsAreEvenOverTheTriangle) {
  Scene s;
  s.materials[addMaterial(s, glm::vec3(0))].emission = glm::vec3(1);
  addQuad(s, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Lit lit(std::move(s));
  const Emitters emitters(lit.frame);
  glm::dvec3 mean(0), square(0);
  double count = 0;
  for (uint32_t i = 0; i < 100000; ++i) {
    const EmitterPoint p =
        emitters.sample({{0.5f, 0.5f, 2}, {0, 0, -1}}, number(i, 0), number(i, 1), number(i, 2));
    if (!p.hit) continue;
    const glm::dvec3 weights(1 - p.hit.u - p.hit.v, p.hit.u, p.hit.v);
    mean += weights;
    square += weights * weights;
    ++count;
  }
  EXPECT_GT(count, 99000);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k] / count, 1 / 3.0, 0.005);
    EXPECT_NEAR(square[k] / count, 1 / 6.0, 0.005);
  }
}

// Of two equal groups of panels, the closer one and the one that turns towards the receiver are chosen more often, and
// what lies below its horizon is not chosen at all.
TEST(PathTraceEmitters, ChoosesWhatSendsMoreLight) {
  Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0));
  s.materials[m].emission = glm::vec3(1);
  constexpr float kSmall = 0.01f;
  for (int i = 0; i < 8; ++i) {
    const float y = float(i) * kSmall;
    addQuad(s, m, {-1, y, 0}, {kSmall, 0, 0}, {0, kSmall, 0});  // faces the receiver's side
    addQuad(s, m, {3, y, 0}, {kSmall, 0, 0}, {0, kSmall, 0});   // the same, farther away
    addQuad(s, m, {1, y, 0}, {0, kSmall, 0}, {0, 0, kSmall});   // turned away
    for (const float x : {-0.5f, 0.5f}) addQuad(s, m, {x, y, 3}, {-kSmall, 0, 0}, {0, kSmall, 0});  // behind
  }
  const Lit lit(std::move(s));
  const Emitters emitters(lit.frame);
  int near = 0, far = 0, turned = 0, behind = 0;
  for (uint32_t i = 0; i < 20000; ++i) {
    const EmitterPoint p = emitters.sample({{0, 0, 1}, {0, 0, -1}}, number(i, 0), number(i, 1), number(i, 2));
    if (!p.hit) continue;
    const float x = p.position.x;
    ++(p.position.z > 2 ? behind : x < 0 ? near : x > 2 ? far : turned);
  }
  EXPECT_EQ(behind, 0);
  EXPECT_EQ(turned, 0);
  EXPECT_GT(near, 5 * far);
  EXPECT_GT(far, 100);
}

TEST(PathTraceEnvironment, LooksLikeTheMap) {
  const auto map = test::skyWithSun();
  const Environment environment(*map);
  for (uint32_t i = 0; i < 5000; ++i) {
    const glm::vec3 d = unit(i, 0), want = map->radiance(d);
    ASSERT_LT(glm::distance(environment.radiance(d), want), 1e-4f * glm::length(want)) << i;
  }
}

// The mean of radiance over density is the light from all directions, and its spread is small, as directions are chosen
// in proportion to the light. The density is that of all directions together.
TEST(PathTraceEnvironment, DirectionsAreInProportionToTheLight) {
  const auto map = test::skyWithSun();
  const Environment environment(*map);
  constexpr uint32_t kSamples = 100000;
  double mean = 0, squares = 0;
  for (uint32_t i = 0; i < kSamples; ++i) {
    const Environment::Sample s = environment.sample(number(i, 0), number(i, 1));
    ASSERT_GT(s.density, 0);
    ASSERT_NEAR(glm::length(s.direction), 1, 1e-5f);
    ASSERT_EQ(s.radiance, environment.radiance(s.direction));
    const double value = double(s.radiance.g / s.density);
    mean += value / kSamples;
    squares += value * value / kSamples;
  }
  double light = 0, density = 0;
  constexpr int kSide = 800;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < 2 * kSide; ++i) {
      const double z = 1 - 2 * (j + 0.5) / kSide, phi = (i + 0.5) / kSide * glm::pi<double>(),
                   across = std::sqrt(1 - z * z);
      const glm::vec3 d(across * std::sin(phi), z, across * std::cos(phi));
      light += double(environment.radiance(d).g) * 4 * glm::pi<double>() / (2.0 * kSide * kSide);
      density += double(environment.density(d)) * 4 * glm::pi<double>() / (2.0 * kSide * kSide);
    }
  const double deviation = std::sqrt(squares - mean * mean);
  EXPECT_NEAR(mean, light, 5 * deviation / std::sqrt(double(kSamples)) + 1e-3 * light);
  EXPECT_LT(deviation, light);
  EXPECT_NEAR(density, 1, 2e-3);
}

TEST(PathTraceEnvironment, SamplesHaveTheDensityOfTheirDirection) {
  const auto map = test::skyWithSun();
  const Environment environment(*map);
  int differ = 0;  // at the edges of texels, by rounding
  for (uint32_t i = 0; i < 10000; ++i) {
    const Environment::Sample s = environment.sample(number(i, 0), number(i, 1));
    differ += std::abs(environment.density(s.direction) - s.density) > 1e-4f * s.density;
  }
  EXPECT_LT(differ, 10);
}

TEST(PathTraceEnvironment, ABlackMapIsNotChosen) {
  const EnvironmentMap map(4, 2, std::vector<glm::vec3>(8, glm::vec3(0)));
  EXPECT_EQ(Environment(map).sample(0.3f, 0.6f).density, 0);
  EXPECT_EQ(Environment(map).density({0, 1, 0}), 0);
}

}  // namespace
}  // namespace fovea::path_trace
