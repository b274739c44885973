// Tests light paths one by one against a plain tracer, and on the host against the device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/base/low_discrepancy.h"
#include "framework/base/random.h"
#include "framework/scene/scene.h"
#include "shaders/records/light_paths.h"
#include "shaders/records/vpl.h"
#include "tests/passes/emitted_vpls.h"
#include "tests/passes/ray_reference.h"
#include "tests/references/paraboloid.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr uint32_t kSeed = 5, kCount = 200;
constexpr int kBounces = 3;

// The VPLs of the paths of one point light in a scene of untextured, diffuse surfaces, in double precision, as they are
// before the last slots are filled.
std::vector<Vpl> plainPaths(const scene::Scene& s, const scene::Geometry& g) {
  const uint32_t seed = randomStream(kSeed, 0, passes::kLightPathStream, 0);
  const scene::Light& light = s.lights[0];
  std::vector<Vpl> vpls;
  for (uint32_t index = 0;; ++index) {
    const auto number = [&](uint32_t dimension) { return double(sobol(index, dimension, seed)); };
    glm::dvec3 origin(light.position), flux = glm::dvec3(light.color) * double(light.intensity) * 4.0 * kPi;
    const double z = 1 - 2 * number(1), r = std::sqrt(1 - z * z), phi = 2 * kPi * number(2);
    glm::dvec3 direction(r * std::cos(phi), r * std::sin(phi), z);
    std::vector<Vpl> path;
    for (uint32_t bounce = 1; bounce <= kBounces; ++bounce) {
      const RayHit hit = castRay(s, g, origin, direction);
      if (!hit) break;
      const auto& corners = g.triangles[hit.triangle].v;
      const glm::dvec3 a(g.positions[corners[0]]), b(g.positions[corners[1]]), c(g.positions[corners[2]]);
      glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
      if (glm::dot(normal, direction) > 0) normal = -normal;
      const glm::dvec3 rho(s.materials[g.triangles[hit.triangle].material()].baseColor);
      flux *= rho;
      origin += hit.t * direction;
      Vpl v;
      v.position = glm::vec3(origin);
      v.normal = glm::vec3(normal);
      v.intensity = glm::vec3(flux / kPi);
      path.push_back(v);
      const double survival = std::max({rho.r, rho.g, rho.b});
      const uint32_t first = 4 * (bounce + 1);
      if (number(first + 2) >= survival) break;
      flux /= survival;
      const double across = std::sqrt(number(first)), around = 2 * kPi * number(first + 1);
      const glm::dmat3 axes(scene::orthonormalFrame(glm::vec3(normal)));
      direction = axes * glm::dvec3(across * std::cos(around), across * std::sin(around),
                                    std::sqrt(1 - across * across));
      origin += 1e-6 * normal;
    }
    if (vpls.size() + path.size() > kCount) {
      for (Vpl& v : vpls) v.intensity /= float(index);
      return vpls;
    }
    vpls.insert(vpls.end(), path.begin(), path.end());
  }
}

// Half of the room is open, so that paths escape.
scene::Scene openRoom() {
  scene::Scene s;
  uint32_t materials[6];
  for (int i = 0; i < 6; ++i)
    materials[i] = addMaterial(s, {0.9f - 0.1f * float(i), 0.3f + 0.1f * float(i), 0.5f});
  addRoom(s, materials, 2);
  for (size_t i : {0, 3}) s.nodes[i].mesh = scene::kNoIndex;
  s.lights = {pointLight({0.3f, -0.4f, 0.5f}, {10, 20, 30})};
  return s;
}

class EmitOn : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Rays, EmitOn, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& on) { return on.param ? "Host" : "Device"; });

TEST_P(EmitOn, FollowsThePathsOfThePlainTracer) {
  const scene::Scene s = openRoom();
  PassTest test("emit");
  test.seed(kSeed).raysOnHost(GetParam()).param("count", int(kCount)).param("bounces", kBounces);
  const auto got = emitted(test, s);
  std::vector<Vpl> wanted = plainPaths(s, test.geometry());
  ASSERT_GE(wanted.size() + kBounces, kCount);
  EXPECT_GT(test.counter("escaped"), 0);
  EXPECT_EQ(filled(got), int(kCount));
  // Each is found once; what is left over are those that fill the last slots, at places that were there before.
  const size_t extra = kCount - wanted.size();
  size_t without = 0, halved = 0;
  for (const Vpl& v : got) {
    const auto match = std::ranges::find_if(wanted, [&](const Vpl& w) {
      return glm::distance(v.position, w.position) < 5e-3f && glm::dot(v.normal, w.normal) > 0.999f;
    });
    if (match == wanted.end()) {
      ++without;
      continue;
    }
    if (v.intensity.g < 0.9f * match->intensity.g)
      ++halved;
    else
      EXPECT_NEAR(v.intensity.g, match->intensity.g, 1e-3f * match->intensity.g);
    wanted.erase(match);
  }
  EXPECT_EQ(without, extra);
  EXPECT_LE(halved, extra);
  EXPECT_TRUE(wanted.empty());
}

// The same light whether it is found on the host or on the device, from sources of all kinds.
TEST(Emit, HostAndDeviceFindTheSameVpls) {
  scene::Scene s = room({0.7f, 0.5f, 0.3f});
  s.materials.push_back(s.materials[0]);
  s.materials.back().emission = {2, 1, 0.5f};
  for (int i = 0; i < 12; ++i)
    addQuad(s, 1, {-1.5f + 0.25f * float(i), 1.9f, -0.5f}, {0.2f, 0, 0}, {0, 0, 0.1f * float(i + 1)});
  s.lights = {pointLight({0.3f, -0.4f, 0.5f}, {1, 2, 3}), sun({0, -1, 0.2f}, glm::vec3(1)),
              spotLight({0, 1, 0}, {0, -1, 0}, 0.3f, 0.6f, glm::vec3(7))};
  PassTest host("emit"), device("emit");
  const auto want = emitted(host.raysOnHost(true).param("count", 500), s),
             got = emitted(device.raysOnHost(false).param("count", 500), s);
  EXPECT_EQ(host.counter("paths"), device.counter("paths"));
  int different = 0;
  for (size_t i = 0; i < want.size(); ++i)
    different += glm::distance(want[i].position, got[i].position) > 1e-3f;
  EXPECT_LE(different, 25);  // rounding exchanges neighbours along the curve
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(totalFlux(want)[c], totalFlux(got)[c], 2e-3 * totalFlux(want)[c]);
}

// More emitters than a leaf of their tree holds, of very different power, some of them on both sides, beside a lamp.
TEST(Emit, ManyEmittersSendTheirPower) {
  scene::Scene s = room(glm::vec3(0));
  addMaterial(s, glm::vec3(0));
  s.materials[1].emission = {3, 1, 0.2f};
  addMaterial(s, glm::vec3(0));
  s.materials[2].emission = {0.1f, 0.4f, 2};
  s.materials[2].doubleSided = true;
  glm::dvec3 power(0);
  for (int i = 0; i < 20; ++i) {
    const float x = -1.8f + 0.18f * float(i), side = 0.02f + 0.007f * float(i);
    const uint32_t material = i % 3 == 0 ? 2 : 1;
    addQuad(s, material, {x, 0.1f * float(i % 5), -1}, {side, 0, 0}, {0, 0, side});
    power += kPi * double(side) * double(side) * (material == 2 ? 2.0 : 1.0) *
             glm::dvec3(s.materials[material].emission);
  }
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(0.1f))};
  PassTest test("emit");
  test.param("count", 20000).param("bounces", 1);
  expectFlux(emitted(test, s), power, 0.01);  // the walls are black
}

}  // namespace
}  // namespace fovea::test
