#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "fovea/scene.h"
#include "framework/base/random.h"
#include "framework/scene/load.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/path-trace/lights.h"
#include "tests/passes/voxel_light.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

const glm::vec3 kRho(0.5f, 0.25f, 0.75f);

// The point set of a side, as light_inject.comp describes it.
std::vector<glm::dvec3> tapsOf(const scene::VoxelGrid& grid, const scene::VoxelSide& side, uint32_t number,
                               int taps, int light) {
  const glm::vec3 at = grid.worldToVoxel(side.position);
  const glm::vec3 low = grid.voxelToWorld(glm::floor(at)), n = side.normal, a = glm::abs(n);
  const glm::vec3 reach = glm::max(glm::min(side.position - low, low + grid.cell - side.position), 0.0f);
  const int w = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2, u = (w + 1) % 3, v = (w + 2) % 3;
  const float shrink =
      std::min(1.0f, std::sqrt(side.area / std::max(4 * reach[u] * reach[v] / a[w], 1e-30f)));
  const glm::uvec3 cell(glm::max(at, glm::vec3(0)));
  const uint32_t bits = randomStream(0x11c7, cell.x, cell.y, 2 * cell.z + (number & 1));
  std::vector<glm::dvec3> points;
  for (int i = light * taps; i < (light + 1) * taps; ++i) {
    glm::vec3 p(0);
    p[u] = shrink * reach[u] * (2 * glm::fract(uniformFloat(bits) + float(i) * 0.7548776662f) - 1);
    p[v] = shrink * reach[v] * (2 * glm::fract(uniformFloat(hashPcg(bits)) + float(i) * 0.5698402910f) - 1);
    p[w] = -(p[u] * n[u] + p[v] * n[v]) / n[w];
    points.push_back(glm::dvec3(side.position + p));
  }
  return points;
}

glm::dvec3 irradiance(const scene::Light& light, glm::dvec3 position, glm::dvec3 normal) {
  const path_trace::IncidentLight l = path_trace::incidentLight(light, glm::vec3(position));
  return glm::dvec3(l.irradiance) * std::max(0.0, glm::dot(normal, glm::dvec3(l.direction)));
}

scene::Scene mixedScene() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, kRho), glowing = addMaterial(s, {0.2f, 0.3f, 0.4f});
  s.materials[glowing].emission = {1, 2, 0.25f};
  addQuad(s, grey, {-1, -0.8f, -1}, {0, 0, 2}, {2, 0.3f, 0});
  addQuad(s, glowing, {-0.4f, 0.9f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f});
  addHollowSphere(s, grey, {0.2f, 0.3f, -0.3f}, 0.6f, 16, 8);
  return s;
}

std::vector<scene::Light> everyLight() {
  scene::Light ranged = pointLight({0.5f, 0.2f, 0.7f}, {2, 3, 1});
  ranged.range = 1.7f;
  return {sun({0.3f, -1, 0.2f}, {3, 2, 1}), pointLight({-0.2f, 0.1f, 0.4f}, {1, 2, 3}),
          spotLight({-0.5f, 0.8f, 0.5f}, {0.4f, -1, -0.2f}, 0.3f, 0.8f, {5, 4, 6}), ranged};
}

// Of more than 16 lights each is evaluated at fewer points: of 24 at 16 / 24 of them, of 100 at one.
TEST(LightInject, EveryLightEqualsTheReference) {
  const struct {
    int taps, copies, expected;
  } cases[] = {{1, 1, 1}, {6, 1, 6}, {6, 6, 4}, {12, 6, 8}, {6, 25, 1}};
  for (const auto& [asked, copies, taps] : cases) {
    scene::Scene model = mixedScene();
    for (int i = 0; i < copies; ++i)
      for (const scene::Light& light : everyLight()) model.lights.push_back(light);
    const VoxelScene s(model, 24);
    const auto got = inject(s, {.taps = asked});
    size_t compared = 0;
    for (uint32_t i = 0; i < s.sides().size(); ++i) {
      const scene::VoxelSide& side = s.sides()[i];
      if (side.area <= 0) {
        ASSERT_EQ(got[i], glm::vec4(0));
        continue;
      }
      glm::dvec3 want(0);
      for (size_t light = 0; light < model.lights.size(); ++light)
        for (const glm::dvec3 p : tapsOf(s.voxels.grid, side, i, taps, int(light)))
          want += irradiance(model.lights[light], p, side.normal) / double(taps);
      want = glm::dvec3(side.reflectance) * want / glm::pi<double>() + glm::dvec3(side.emission);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[i][c], want[c], 2e-3 * want[c] + 1e-5) << "side " << i;
      ASSERT_NEAR(got[i].w, luminance(got[i]), 1e-5f + 1e-5f * got[i].w);
      ++compared;
    }
    EXPECT_GT(compared, 400u);
  }
}

// Compares rho E A of all sides of a plane with the integral over the plane by far finer points.
TEST(LightInject, PlaneReceivesTheLightOfTheClosedForm) {
  for (const scene::Light& light : everyLight()) {
    scene::Scene model;
    addQuad(model, addMaterial(model, kRho), {-1, -0.5f, -1}, {0, 0, 2}, {2, 0, 0});
    model.lights = {light};
    const VoxelScene s(model, 32);
    const auto got = inject(s);
    glm::dvec3 sum(0), want(0);
    for (uint32_t i = 0; i < s.sides().size(); ++i)
      sum += glm::pi<double>() * glm::dvec3(got[i]) * double(s.sides()[i].area);
    constexpr int kFine = 1000;
    for (int y = 0; y < kFine; ++y)
      for (int x = 0; x < kFine; ++x)
        want += glm::dvec3(kRho) *
                irradiance(light, {2 * (x + 0.5) / kFine - 1, -0.5, 2 * (y + 0.5) / kFine - 1}, {0, 1, 0}) *
                (4.0 / kFine / kFine);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], want[c], 3e-3 * want[c]) << int(light.type) << ' ' << c;
  }
}

// What arrives at every side, computed with rays from random points of its surface.
std::vector<double> tracedIrradiance(const VoxelScene& s) {
  const scene::RayScene rays(s.scene, s.geometry);
  std::vector<double> sum(s.sides().size()), points(s.sides().size());
  uint32_t stream = 0;
  for (const scene::Triangle& t : s.geometry.triangles) {
    const glm::vec3 a = s.geometry.positions[t.v[0]], b = s.geometry.positions[t.v[1]],
                    c = s.geometry.positions[t.v[2]];
    const glm::vec3 cross = glm::cross(b - a, c - a);
    const float area = 0.5f * glm::length(cross), cell = s.voxels.grid.cell;
    if (area <= 0) continue;
    const glm::vec3 normal = cross / (2 * area);
    const int count = 4 + int(24 * area / (cell * cell));
    for (int i = 0; i < count; ++i) {
      float u = uniformFloat(hashPcg(++stream)), v = uniformFloat(hashPcg(hashPcg(stream) + 77));
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const glm::vec3 p = a + u * (b - a) + v * (c - a);
      const glm::ivec3 at(s.voxels.grid.worldToVoxel(p));
      const uint32_t voxel = s.voxels.voxelAt(at);
      if (!voxel) continue;
      const uint32_t side = 2 * (voxel - 1) + scene::voxelSideOf(normal);
      const double weight = double(area) / count;
      points[side] += weight;
      for (const scene::Light& light : s.scene.lights) {
        const path_trace::IncidentLight l = path_trace::incidentLight(light, p);
        const float cosine = glm::dot(normal, l.direction);
        if (cosine <= 0 || l.irradiance.g <= 0) continue;
        const float far = std::min(l.distance, 1e4f) * 0.9999f;
        if (!rays.occluded({p + normal * rays.epsilon() * 4.0f, l.direction, 0, far}))
          sum[side] += weight * cosine * l.irradiance.g;
      }
    }
  }
  for (size_t i = 0; i < sum.size(); ++i) sum[i] /= std::max(points[i], 1e-30);
  return sum;
}

struct Balance {
  double total = 0, lost = 0, leaked = 0;  // parts of the light that arrives
};

Balance balance(const VoxelScene& s, const std::vector<double>& traced, const Inject& options) {
  const auto got = inject(s, options);
  Balance b;
  double all = 0;
  for (uint32_t i = 0; i < s.sides().size(); ++i) {
    const scene::VoxelSide& side = s.sides()[i];
    if (side.area <= 0 || side.reflectance.g <= 0.01f) continue;
    const double e = glm::pi<double>() * (got[i].g - side.emission.g) / side.reflectance.g, area = side.area;
    all += traced[i] * area;
    b.total += e * area;
    b.lost += std::max(0.0, traced[i] - e) * area;
    b.leaked += std::max(0.0, e - traced[i]) * area;
  }
  b.total /= all;
  b.lost /= all;
  b.leaked /= all;
  return b;
}

// The Cornell box with maps against rays. Sampling a quarter of a cell above the plane costs nothing and avoids the
// loss to shadows of the own surface.
TEST(LightInject, CornellBoxReceivesWhatRaysSay) {
  const VoxelScene s(scene::builtin("cornellbox"), 64);
  const std::vector<double> traced = tracedIrradiance(s);
  std::map<double, Balance> by;
  for (const double offset : {0.0, 0.25, 0.5, 1.0}) {
    by[offset] = balance(s, traced, {.offset = offset, .shadows = true});
    std::printf("offset %.2f cells: %.4f of the traced light, %.4f lost, %.4f leaked\n", offset,
                by[offset].total, by[offset].lost, by[offset].leaked);
  }
  EXPECT_NEAR(by[0.25].total, 1, 0.01);
  EXPECT_LT(by[0.25].lost, 0.03);
  EXPECT_LT(by[0.25].leaked, 0.03);
}

TEST(LightInject, SunOnCurvedAndThinSurfaces) {
  scene::Scene model = mixedScene();
  model.lights = {sun({0.3f, -1, 0.2f}, {3, 2, 1})};
  const VoxelScene s(model, 48);
  const Balance b = balance(s, tracedIrradiance(s), {.shadows = true});
  std::printf("sun, curved and thin surfaces: %.4f of the traced light, %.4f lost, %.4f leaked\n", b.total,
              b.lost, b.leaked);
  EXPECT_NEAR(b.total, 1, 0.03);
  EXPECT_LT(b.lost, 0.06);
  EXPECT_LT(b.leaked, 0.06);
}

TEST(LightInject, StillLightGivesStillValues) {
  scene::Scene model = mixedScene();
  model.lights = everyLight();
  const VoxelScene s(model, 24);
  EXPECT_EQ(inject(s, {.shadows = true}), inject(s, {.shadows = true}, 4));
}

TEST(LightInject, NothingToLightAndNoLight) {
  const VoxelScene nothing({}, 8);
  EXPECT_TRUE(inject(nothing).empty());
  EXPECT_TRUE(inject(nothing, {.shadows = true}).empty());
  const VoxelScene dark(mixedScene(), 16);
  const auto got = inject(dark, {.shadows = true});
  for (uint32_t i = 0; i < dark.sides().size(); ++i)
    ASSERT_LT(glm::distance(glm::vec3(got[i]), dark.sides()[i].emission), 1e-6f);
  for (const glm::vec4& side : inject(dark, {.emission = false})) ASSERT_EQ(side, glm::vec4(0));
}

}  // namespace
}  // namespace fovea::test
