#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "framework/graph/compile/compile.h"
#include "framework/session/graph_run.h"
#include "tests/passes/ray_reference.h"
#include "tests/passes/shadow_view.h"
#include "tests/support/raster_grid.h"

namespace fovea::test {
namespace {

constexpr int kSize = 96;

// A floor, a box on it, a tilted masked quad above, and one light of each type.
scene::Scene litScene() {
  scene::Scene s;
  s.textures.push_back(checkerTexture());
  scene::Material plain, masked;
  masked.baseColorTexture.texture = 0;
  masked.masked = true;
  s.materials = {plain, masked};
  addQuad(s, 0, {-3, 0, 2}, {3, 0, 2}, {3, 0, -2}, {-3, 0, -2});
  addBox(s, 0, {-1, 0, -0.5f}, {0, 1, 0.5f});
  addQuad(s, 1, {0.5f, 0.8f, 0.6f}, {1.7f, 0.9f, 0.6f}, {1.7f, 1.3f, -0.7f}, {0.5f, 1.2f, -0.7f});
  scene::Light sun, point, spot;
  sun.direction = glm::normalize(glm::vec3(0.4f, -1, 0.2f));
  point.type = scene::LightType::Point;
  point.position = {1.1f, 2, 0.1f};
  spot.type = scene::LightType::Spot;
  spot.position = {-2.5f, 2.5f, 1.5f};
  spot.direction = glm::normalize(glm::vec3(1.5f, -2, -1.2f));
  spot.outerConeAngle = 0.6f;
  s.lights = {sun, point, spot};  // layers 0, 1 to 6, 7
  s.cameras.emplace_back();
  return s;
}

glm::dvec3 unproject(const glm::dmat4& clipToWorld, double x, double y, double depth) {
  const glm::dvec4 p = clipToWorld * glm::dvec4(x, y, depth, 1);
  return glm::dvec3(p) / p.w;
}

// Depth that a ray through image position (x, y) of a layer finds; 0 where it hits nothing.
double castDepth(const scene::Scene& scene, const scene::Geometry& geometry, const glm::dmat4& worldToClip,
                 const glm::dmat4& clipToWorld, double x, double y) {
  const double cx = 2 * x / kSize - 1, cy = 2 * y / kSize - 1;
  const glm::dvec3 origin = unproject(clipToWorld, cx, cy, 1);
  const glm::dvec3 direction = glm::normalize(unproject(clipToWorld, cx, cy, 0.5) - origin);
  const RayHit hit = castRay(scene, geometry, origin, direction);
  if (!hit) return 0;
  const glm::dvec4 p = worldToClip * glm::dvec4(origin + hit.t * direction, 1);
  return p.z / p.w;
}

class ShadowMapTest : public testing::Test {
 protected:
  void render() {
    test_.param("size", kSize).scene(scene_);
    test_.run();
    depth_ = test_.floats("maps.depth");
    views_ = test_.values<ShadowView>("maps.views");
  }
  // x, y in [-1, 1] and depth of a world-space point in a layer.
  glm::dvec3 project(int layer, glm::vec3 p) const {
    const glm::dvec4 c = glm::dmat4(views_[layer].worldToClip) * glm::dvec4(p, 1);
    return c.w > 0 ? glm::dvec3(c) / c.w : glm::dvec3(1e9);
  }
  scene::Scene scene_ = litScene();
  PassTest test_{"shadow-map"};
  std::vector<float> depth_;
  std::vector<ShadowView> views_;
};

bool inside(glm::dvec3 p) { return std::abs(p.x) < 1 && std::abs(p.y) < 1 && p.z > 0 && p.z < 1; }

TEST_F(ShadowMapTest, DepthEqualsRays) {
  render();
  ASSERT_EQ(test_.desc("maps.depth").layers, 8u);
  ASSERT_EQ(depth_.size(), size_t(8) * kSize * kSize);
  const double hair = std::max(1.0 / 128, double(rasterGrid()));
  for (int layer = 0; layer < 8; ++layer) {
    const glm::dmat4 worldToClip(views_[layer].worldToClip), clipToWorld = glm::inverse(worldToClip);
    int edges = 0, wrong = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double got = depth_[(size_t(layer) * kSize + y) * kSize + x];
        // Vertices are snapped to a grid, so the true value lies between those of rays around the centre.
        double lo = 2, hi = -1;
        for (double r = 1.0 / 128; r <= hair; r *= 2)
          for (const glm::dvec2 d : {glm::dvec2(0), {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}) {
            const double z = castDepth(scene_, test_.geometry(), worldToClip, clipToWorld, x + 0.5 + d.x * r,
                                       y + 0.5 + d.y * r);
            lo = std::min(lo, z);
            hi = std::max(hi, z);
          }
        const double tolerance = views_[layer].bias + views_[layer].relativeBias * hi;
        wrong += got < lo - 0.5 * tolerance || got > hi + 0.5 * tolerance;
        edges += hi - lo > 0.05 * hi;
      }
    EXPECT_EQ(wrong, 0) << "layer " << layer;
    EXPECT_LT(edges, kSize * kSize / 50 * 128 * hair) << "layer " << layer;
  }
}

TEST_F(ShadowMapTest, SunSeesTheWholeSceneTightly) {
  render();
  const scene::Geometry& g = test_.geometry();
  glm::dvec3 most(0);
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner = glm::mix(g.boundsMin, g.boundsMax, glm::bvec3(i & 1, i & 2, i & 4));
    const glm::dvec3 p = project(0, corner);
    EXPECT_TRUE(inside(p)) << "corner " << i << ": " << p.x << " " << p.y << " " << p.z;
    most = glm::max(most, glm::abs(p));
    // Along the light only the depth changes, and it decreases.
    const glm::dvec3 further = project(0, corner + 0.1f * scene_.lights[0].direction);
    EXPECT_NEAR(p.x, further.x, 1e-5);
    EXPECT_NEAR(p.y, further.y, 1e-5);
    EXPECT_LT(further.z, p.z);
  }
  const double guarded = 1 - 12.0 / kSize;  // a few texels of margin for the filter
  EXPECT_GT(most.x, guarded);
  EXPECT_GT(most.y, guarded);
  // No map turned about the light's direction could be smaller.
  const glm::dvec3 extent(g.boundsMax - g.boundsMin), x(views_[0].right), y(views_[0].up);
  const auto areaAt = [&](double angle) {
    const glm::dvec3 right = std::cos(angle) * x + std::sin(angle) * y,
                     up = std::cos(angle) * y - std::sin(angle) * x;
    return glm::dot(glm::abs(right), extent) * glm::dot(glm::abs(up), extent);
  };
  for (int i = 1; i < 180; ++i) EXPECT_LT(areaAt(0), 1.0001 * areaAt(glm::radians(double(i)))) << i;
}

TEST_F(ShadowMapTest, SpotSeesItsConeTightly) {
  render();
  const scene::Light& spot = scene_.lights[2];
  const glm::vec3 side = glm::normalize(glm::cross(spot.direction, glm::vec3(0, 1, 0)));
  const glm::vec3 other = glm::cross(spot.direction, side);
  double most = 0;
  for (int i = 0; i < 32; ++i) {
    const float a = float(i) / 32 * glm::two_pi<float>();
    const glm::vec3 rim = std::cos(spot.outerConeAngle) * spot.direction +
                          std::sin(spot.outerConeAngle) * (std::cos(a) * side + std::sin(a) * other);
    const glm::dvec3 p = project(7, spot.position + 2.0f * rim);
    EXPECT_TRUE(inside(p));
    EXPECT_LT(project(7, spot.position + 3.0f * rim).z, p.z);
    most = std::max({most, std::abs(p.x), std::abs(p.y)});
  }
  EXPECT_GT(most, 1 - 14.0 / kSize);
}

TEST_F(ShadowMapTest, CubeFacesSeeEveryDirection) {
  render();
  const scene::Light& point = scene_.lights[1];
  for (uint32_t i = 0; i < 1000; ++i) {
    glm::vec3 d;
    for (int c = 0; c < 3; ++c) d[c] = 2 * uniformFloat(randomStream(5, 0, uint32_t(c), i)) - 1;
    const glm::vec3 a = glm::abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const int face = 2 * axis + (d[axis] < 0);
    EXPECT_TRUE(inside(project(1 + face, point.position + d))) << "face " << face;
    EXPECT_FALSE(inside(project(1 + (face ^ 1), point.position + d)));
  }
}

TEST_F(ShadowMapTest, TexelSizesAreThoseOfTheProjection) {
  render();
  const glm::vec3 p(0.3f, 0.4f, -0.2f);
  for (int layer = 0; layer < 8; ++layer) {
    const ShadowView& v = views_[layer];
    const double w = (glm::dmat4(v.worldToClip) * glm::dvec4(p, 1)).w;
    if (w < 0.1) continue;
    const glm::dvec3 at = project(layer, p);
    const glm::dvec3 x = project(layer, p + float(v.texelWidth * w) * v.right);
    const glm::dvec3 y = project(layer, p + float(v.texelHeight * w) * v.up);
    EXPECT_NEAR((x.x - at.x) * 0.5 * kSize, 1, 1e-3) << "layer " << layer;
    EXPECT_NEAR((y.y - at.y) * 0.5 * kSize, 1, 1e-3) << "layer " << layer;
    EXPECT_NEAR(x.y, at.y, 1e-4);
    EXPECT_NEAR(y.x, at.x, 1e-4);
  }
}

TEST(ShadowMap, WithoutLightsThereIsOneEmptyLayer) {
  scene::Scene s = litScene();
  s.lights.clear();
  PassTest test("shadow-map");
  test.param("size", 16).scene(s);
  test.run();
  EXPECT_EQ(test.floats("maps.depth"), std::vector<float>(16 * 16, 0.0f));
}

// With 51 point lights there are 306 maps, and none of them gets the 2048x2048 texels that were asked for.
TEST(ShadowMap, ManyLightsShareTheTexels) {
  scene::Scene s = litScene();
  s.lights.assign(51, s.lights[1]);
  Diagnostics messages;
  const auto description = graph::loadText(
      R"({"passes": {"lights": {"type": "shadow-map"}}, "outputs": {"depth": "lights.maps.depth"}})",
      "g.json", {}, messages);
  const auto bound =
      graph::bind(description, session::sceneEnvironment(nullptr, s, scene::flatten(s), {16, 16}), messages);
  const auto depth = std::ranges::find(bound.resources, "lights.maps.depth", &graph::BoundResource::name);
  ASSERT_NE(depth, bound.resources.end());
  EXPECT_EQ(depth->desc.layers, 306u);
  EXPECT_EQ(depth->desc.width, 662u);
  EXPECT_EQ(depth->desc.height, 662u);
}

// As many lights as there may be, of which each sees what is in front of it: 80 points and 48 spots, with 528 maps.
TEST(ShadowMap, EveryLightHasItsView) {
  scene::Scene s = litScene();
  const scene::Light point = s.lights[1], spot = s.lights[2];
  s.lights.clear();
  for (int i = 0; i < 128; ++i) {
    s.lights.push_back(i < 80 ? point : spot);
    s.lights.back().position = {0.01f * float(i), 2.5f, -0.3f};
  }
  PassTest test("shadow-map");
  test.param("size", 16).scene(s);
  test.run();
  const auto views = test.values<ShadowView>("maps.views");
  ASSERT_EQ(test.desc("maps.depth").layers, 528u);
  for (size_t layer = 0; layer < 528; ++layer) {
    const size_t light = layer < 480 ? layer / 6 : layer - 400, axis = layer % 6 / 2;
    glm::vec3 forward = s.lights[light].direction;
    if (light < 80) forward = glm::vec3(0), forward[int(axis)] = layer % 2 == 0 ? 1 : -1;
    const glm::vec4 clip = views[layer].worldToClip * glm::vec4(s.lights[light].position + 2.0f * forward, 1);
    EXPECT_NEAR(clip.w, 2, 1e-5) << layer;
    EXPECT_LT(glm::length(glm::vec2(clip)), 1e-5f) << layer;
  }
}

}  // namespace
}  // namespace fovea::test
