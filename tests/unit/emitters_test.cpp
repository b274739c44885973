#include "framework/scene/rays/emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "framework/base/random.h"
#include "framework/scene/rays/surface_tracer.h"
#include "tests/support/shapes.h"

namespace fovea::scene {
namespace {

using test::addMaterial;
using test::addQuad;

float number(uint32_t i, uint32_t what) { return uniformFloat(randomStream(7, what, 0, i)); }

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

// The density is that of the samples: 1 / density has the emitters' area as its mean, and each triangle is chosen as
// often as its density says.
TEST(Emitters, DensityIsThatOfTheSamples) {
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
      if (p.triangle == kNoIndex) continue;
      chosen[p.triangle] += 1.0 / kSamples;
      ASSERT_NEAR(p.density, emitters.density(p.triangle, receiver), 1e-4f * p.density);
      ASSERT_GT(glm::dot(p.normal, receiver.position - p.position), 0);
      ASSERT_EQ(p.radiance, lit.scene.materials[lit.geometry.triangles[p.triangle].material()].emission);
    }
    double sum = 0;
    for (uint32_t t = 0; t < lit.geometry.triangles.size(); ++t) {
      const auto& v = lit.geometry.triangles[t].v;
      const auto& at = lit.geometry.positions;
      const double area = 0.5 * glm::length(glm::cross(at[v[1]] - at[v[0]], at[v[2]] - at[v[0]])),
                   want = area * double(emitters.density(t, receiver));
      EXPECT_NEAR(chosen[t], want, 4.5 * std::sqrt(want / kSamples) + 1e-6) << t << " of " << count;
      sum += want;
    }
    EXPECT_LE(sum, 1.0001);
    EXPECT_GT(sum, 0.3);  // the rest are choices of groups that face away
  }
}

// Of two equal panels the closer one is chosen as often as its light asks for.
TEST(Emitters, ChoosesWhatIsClose) {
  Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0));
  s.materials[m].emission = glm::vec3(1);
  for (int i = 0; i < 16; ++i) {  // enough for a tree
    addQuad(s, m, {-1, float(i) * 0.01f, 0}, {0.01f, 0, 0}, {0, 0.01f, 0});
    addQuad(s, m, {3, float(i) * 0.01f, 0}, {0.01f, 0, 0}, {0, 0.01f, 0});
  }
  const Lit lit(std::move(s));
  const Emitters emitters(lit.frame);
  int left = 0;
  for (uint32_t i = 0; i < 10000; ++i)
    left += emitters.sample({{0, 0, 1}, {0, 0, -1}}, number(i, 0), number(i, 1), number(i, 2)).position.x < 0;
  // Squared distances of 2 and 10, and both cosines are 1 over the distance.
  EXPECT_NEAR(left / 10000.0, 25.0 / 26, 0.02);
}

// Of two equal panels in the same direction, the one that turns towards the receiver is chosen more often, and what
// lies below its horizon is not chosen at all.
TEST(Emitters, ChoosesByBothCosines) {
  Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0));
  s.materials[m].emission = glm::vec3(1);
  for (int i = 0; i < 8; ++i) {  // enough for a tree
    const float small = 0.01f, y = float(i) * small;
    addQuad(s, m, {-1, y, 0}, {small, 0, 0}, {0, small, 0});                   // faces +z
    addQuad(s, m, {1, y, 0}, {0.6f * small, 0, 0.8f * small}, {0, small, 0});  // turned away from the middle
    for (const float x : {-0.5f, 0.5f}) addQuad(s, m, {x, y, 3}, {-small, 0, 0}, {0, small, 0});  // behind
  }
  const Lit lit(std::move(s));
  const Emitters emitters(lit.frame);
  int left = 0, right = 0, behind = 0;
  for (uint32_t i = 0; i < 10000; ++i) {
    const EmitterPoint p = emitters.sample({{0, 0, 1}, {0, 0, -1}}, number(i, 0), number(i, 1), number(i, 2));
    if (p.triangle == kNoIndex) continue;
    ++(p.position.z > 2 ? behind : p.position.x < 0 ? left : right);
  }
  EXPECT_EQ(behind, 0);
  EXPECT_GT(left, 1000);
  // The panels on the right have the normal (-0.8, 0, 0.6): their cosine is 1.4 / sqrt(2) in place of 1 / sqrt(2).
  EXPECT_NEAR(double(right) / left, 1.4, 0.15);
}

TEST(Emitters, WithinReach) {
  const Lit lit(panels(40));
  const Emitters emitters(lit.frame);
  int reached = 0;
  for (uint32_t i = 0; i < 300; ++i) {
    const glm::vec3 p = 9.0f * (glm::vec3(number(i, 0), number(i, 1), number(i, 2)) - 0.5f);
    const float reach = number(i, 3);
    bool want = false;
    for (const Triangle& t : lit.geometry.triangles) {
      if (lit.scene.materials[t.material()].emission == glm::vec3(0)) continue;
      glm::vec3 corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = lit.geometry.positions[t.v[k]];
      const glm::vec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0f;
      float radius = 0;
      for (const glm::vec3& c : corners) radius = std::max(radius, glm::distance(c, centre));
      want = want || glm::distance(p, centre) <= reach + radius;
    }
    EXPECT_EQ(emitters.within(p, reach), want) << i;
    reached += want;
  }
  EXPECT_GT(reached, 30);
  EXPECT_LT(reached, 270);
}

TEST(Emitters, NoneWhereNothingShines) {
  Scene s;
  addQuad(s, addMaterial(s, glm::vec3(0.5f)), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Lit lit(std::move(s));
  const Emitters emitters(lit.frame);
  EXPECT_TRUE(emitters.empty());
  EXPECT_FALSE(emitters.within({0, 0, 0}, 100));
  EXPECT_EQ(emitters.density(0, {{0, 0, 1}, {0, 0, -1}}), 0);
  EXPECT_EQ(emitters.sample({{0, 0, 1}, {0, 0, -1}}, 0.5f, 0.5f, 0.5f).triangle, kNoIndex);
}

TEST(Emitters, NeverFromTheBackOfAPanel) {
  Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0));
  s.materials[m].emission = glm::vec3(1);
  addQuad(s, m, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // shines towards +z
  const Lit lit(std::move(s));
  const Emitters emitters(lit.frame);
  EXPECT_EQ(emitters.sample({{0.5f, 0.5f, -1}, {0, 0, 1}}, 0.5f, 0.5f, 0.5f).triangle, kNoIndex);
  EXPECT_EQ(emitters.density(0, {{0.5f, 0.5f, -1}, {0, 0, 1}}), 0);
  EXPECT_NE(emitters.sample({{0.5f, 0.5f, 1}, {0, 0, -1}}, 0.5f, 0.5f, 0.5f).triangle, kNoIndex);
}

// A small lamp above a floor: few rays hit it by chance, and yet the mean of a few gathers is its irradiance over pi.
// Without a second bounce as well as with one, where points and chance share the light. A large one close by: no
// single gather is brighter than half again the lamp, which its two rays and its point meet at once.
TEST(Emitters, GatheredLightOfALamp) {
  for (const float half : {0.02f, 2.0f}) {
    Scene s;
    const uint32_t grey = addMaterial(s, glm::vec3(0)), lamp = addMaterial(s, glm::vec3(0));
    s.materials[lamp].emission = glm::vec3(5);
    addQuad(s, grey, {-9, 0, -9}, {0, 0, 18}, {18, 0, 0});
    addQuad(s, lamp, {-half, 0.5f, -half}, {2 * half, 0, 0}, {0, 0, 2 * half});  // shines downwards
    const Lit lit(std::move(s));
    const RayScene rays(lit.scene, lit.geometry);
    const SurfaceTracer tracer(lit.frame, lit.frame.views[0], rays);
    TracedSurface v;
    v.there = true;
    v.normal = v.face = {0, 1, 0};
    v.origin = {0, 1e-4f, 0};
    double want = 0;  // integral of cos cos' / (pi d^2) over the lamp, in cells
    constexpr int kCells = 400;
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const double px = (2 * (x + 0.5) / kCells - 1) * half, pz = (2 * (y + 0.5) / kCells - 1) * half,
                     d2 = px * px + pz * pz + 0.25;
        want += 5 * 0.25 / (d2 * d2) / glm::pi<double>() * 4 * half * half / kCells / kCells;
      }
    for (const uint32_t bounces : {0u, 1u}) {
      double sum = 0, most = 0;
      uint64_t count = 0;
      constexpr uint32_t kGathers = 4000;
      for (uint32_t i = 0; i < kGathers; ++i) {
        const double got = tracer.gather(v, bounces, 2, randomStream(3, bounces, 0, i), count).r;
        sum += got / kGathers;
        most = std::max(most, got);
      }
      EXPECT_NEAR(sum / want, 1, 0.03) << half << ", " << bounces;
      if (bounces > 0) {
        EXPECT_LE(most, 1.5 * 5.001) << half;
      }
    }
  }
}

}  // namespace
}  // namespace fovea::scene
