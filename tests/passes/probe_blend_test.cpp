// Compares what probes make of their rays with plain sums over the rays in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/passes/probe_reference.h"

namespace fovea::test {
namespace {

constexpr int kProbes = 70,
              kRays = 24;  // a second row of tiles; the grid has fewer probes than there is room for
constexpr float kSpacing = 0.75f;

// Rays that hit front faces, back faces and nothing, or were not traced, and a history of all ages.
struct Rays {
  scene::ProbeGrid grid;
  std::vector<glm::vec4> directions, hits;
  Probes history{kProbes};

  Rays() {
    grid.spacing = kSpacing;
    grid.columns = 3;
    grid.rows = 11;
    grid.layers = 2;
    grid.rays = kRays;
    Numbers numbers(1);
    for (int i = 0; i < kRays; ++i) directions.emplace_back(numbers.direction(), 0);
    for (int i = 0; i < kProbes * kRays; ++i) {
      const float kind = numbers.next(), distance = numbers.next(0.1f, 3);
      const float a = kind < 0.1f ? 0.0f : kind < 0.2f ? -0.2f * distance : kind < 0.3f ? 1e30f : distance;
      const glm::vec3 light(numbers.next(), 2 * numbers.next(), 4 * numbers.next());
      hits.emplace_back(a > 0 ? light : glm::vec3(0), a);
    }
    for (glm::vec4& t : history.irradiance)
      t = {numbers.next(0.2f, 0.8f), numbers.next(0.4f, 1.6f), numbers.next(0.8f, 3.2f), 1};
    for (glm::vec2& t : history.distance) t = {numbers.next(0.5f, 1), numbers.next(1, 2)};
    const float ages[] = {0, 1, 5, 1000};
    for (size_t i = 0; i < kProbes; ++i) history.states[i].frames = ages[i % 4];
  }

  int probes() const { return int(grid.columns * grid.rows * grid.layers); }
  void wire(PassTest& test) const {
    test.buffer("rays.grid", std::vector{grid}, "ProbeGrid");
    test.buffer("rays.directions", directions, "ProbeDirection");
    test.buffer("rays.hits", hits, "ProbeHit");
    history.wire(test, "history");
  }
  const glm::vec4& hit(int probe, int ray) const { return hits[size_t(probe * kRays + ray)]; }
  double cosine(int ray, glm::dvec3 direction) const {
    return std::max(glm::dot(glm::dvec3(directions[size_t(ray)]), direction), 0.0);
  }
  glm::dvec3 light(int probe, glm::dvec3 direction, glm::dvec3 before) const {
    glm::dvec3 sum(0);
    double weights = 0;
    for (int r = 0; r < kRays && probe < probes(); ++r) {
      if (hit(probe, r).a <= 0) continue;
      sum += cosine(r, direction) * glm::dvec3(hit(probe, r));
      weights += cosine(r, direction);
    }
    return weights > 0 ? sum / weights : before;
  }
  double kept(int probe, double hysteresis) const {
    const double frames = history.states[size_t(probe)].frames;
    return std::min(hysteresis, frames / (frames + 3));
  }
};

double relativeChange(glm::dvec3 a, glm::dvec3 b) {
  double difference = 0, most = 1e-6;
  for (int c = 0; c < 3; ++c) {
    difference = std::max(difference, std::abs(std::pow(a[c], 0.2) - std::pow(b[c], 0.2)));
    most = std::max({most, std::pow(a[c], 0.2), std::pow(b[c], 0.2)});
  }
  return difference / most;
}

// With thresholds that some texels reach and others do not.
TEST(ProbeBlend, IrradianceIsTheMeanByCosines) {
  const Rays rays;
  for (const double gamma : {1.0, 5.0}) {
    PassTest test("probe-blend");
    rays.wire(test);
    test.param("hysteresis", 0.9).param("gamma", gamma).param("change", 0.1).param("other", 0.15);
    test.run();
    const auto got = test.values<glm::vec4>("probes.irradiance");
    const ProbeTiles& tiles = rays.history.irradianceTiles;
    ASSERT_EQ(got.size(), tiles.size());
    int same = 0, less = 0, anew = 0;
    for (int probe = 0; probe < kProbes; ++probe)
      for (int y = -1; y <= tiles.side; ++y)
        for (int x = -1; x <= tiles.side; ++x) {
          const size_t i = tiles.at(probe, x, y);
          const glm::dvec3 before(rays.history.irradiance[i]),
              now = rays.light(probe, tiles.direction(x, y), before);
          const double change = relativeChange(now, before);
          if (std::abs(change - 0.1) < 1e-4 || std::abs(change - 0.15) < 1e-4) continue;  // too close to call
          double kept = rays.kept(probe, 0.9);
          ++(change > 0.15 ? anew : change > 0.1 ? less : same);
          if (change > 0.1) kept = change > 0.15 ? 0 : std::max(kept - 0.15, 0.0);
          for (int c = 0; c < 3; ++c) {
            const double a = std::pow(now[c], 1 / gamma), b = std::pow(before[c], 1 / gamma);
            const double want = std::pow(a + kept * (b - a), gamma);
            ASSERT_NEAR(got[i][c], want, 2e-5 * want) << probe << ": " << x << ", " << y;
          }
        }
    EXPECT_GT(same, 100);
    EXPECT_GT(less, 100);
    EXPECT_GT(anew, 100);
  }
}

TEST(ProbeBlend, DistanceIsTheMeanByPowersOfCosines) {
  const Rays rays;
  for (const double sharpness : {1.0, 50.0}) {
    PassTest test("probe-blend");
    rays.wire(test);
    test.param("hysteresis", 0.9).param("sharpness", sharpness).run();
    const auto got = test.values<glm::vec2>("probes.distance");
    const ProbeTiles& tiles = rays.history.distanceTiles;
    ASSERT_EQ(got.size(), tiles.size());
    const double reach = 1.5 * std::sqrt(3.0) * double(kSpacing);
    for (int probe = 0; probe < kProbes; ++probe)
      for (int y = -1; y <= tiles.side; ++y)
        for (int x = -1; x <= tiles.side; ++x) {
          const size_t i = tiles.at(probe, x, y);
          glm::dvec3 sum(0);
          for (int r = 0; r < kRays && probe < rays.probes(); ++r) {
            const double a = rays.hit(probe, r).a, d = std::min(std::abs(a), reach);
            if (a != 0)
              sum += std::pow(rays.cosine(r, tiles.direction(x, y)), sharpness) * glm::dvec3(d, d * d, 1);
          }
          if (probe < rays.probes() && sum.z < 1e-25) continue;  // no ray near this direction
          const glm::dvec2 before(rays.history.distance[i]),
              now = sum.z > 0 ? glm::dvec2(sum) / sum.z : before;
          const glm::dvec2 want = glm::mix(now, before, rays.kept(probe, 0.9));
          for (int c = 0; c < 2; ++c)
            ASSERT_NEAR(got[i][c], want[c], 1e-4 * want[c]) << probe << ": " << x << ", " << y;
        }
  }
}

// ---- Places --------------------------------------------------------------------------------------------------

// One probe with a ray along each half axis, of the lengths given; negative ones hit back faces.
scene::Probe placed(const scene::Probe& before, const std::vector<double>& lengths) {
  scene::ProbeGrid grid;
  grid.spacing = 2;
  grid.rays = 6;
  std::vector<glm::vec4> directions, hits;
  for (size_t i = 0; i < 6; ++i) {
    directions.emplace_back(0);
    directions.back()[int(i / 2)] = i % 2 ? 1.0f : -1.0f;
    hits.emplace_back(0, 0, 0, lengths[i] < 0 ? 0.2 * lengths[i] : lengths[i]);
  }
  Probes history(1);
  history.states[0] = before;
  PassTest test("probe-blend");
  test.buffer("rays.grid", std::vector{grid}, "ProbeGrid");
  test.buffer("rays.directions", directions, "ProbeDirection").buffer("rays.hits", hits, "ProbeHit");
  history.wire(test, "history");
  test.param("clearance", 0.2).param("placing_frames", 4).run();
  return test.values<scene::Probe>("probes.states")[0];
}

void expectPlace(const scene::Probe& probe, glm::vec3 offset, float frames, float inside, float placings) {
  EXPECT_LT(glm::distance(probe.offset, offset), 1e-5f)
      << probe.offset.x << " " << probe.offset.y << " " << probe.offset.z;
  EXPECT_EQ(probe.frames, frames);
  EXPECT_EQ(probe.inside, inside);
  EXPECT_EQ(probe.placings, placings);
}

TEST(ProbeBlend, AProbeInTheOpenStays) {
  expectPlace(placed({}, {3, 2, 3, 3, 1e30, 3}), glm::vec3(0), 1, 0, 1);
  expectPlace(placed({{}, 41, 0, 3}, {3, 2, 3, 3, -3, 3}), glm::vec3(0), 42, 0, 4);  // one back of six
}

// Through the nearest back and half the clearance of 0.4 m beyond it, if that is within 0.45 spacings.
TEST(ProbeBlend, AProbeInsideLeavesThroughTheNearestBack) {
  expectPlace(placed({}, {-3, -0.5, -2, 3, 3, 3}), {0.7, 0, 0}, 0, 1, 1);
  expectPlace(placed({}, {-3, -0.8, -2, 3, 3, 3}), glm::vec3(0), 0, 1, 1);             // too far
  expectPlace(placed({{}, 7, 0, 4}, {-3, -0.5, -2, 3, 3, 3}), glm::vec3(0), 0, 1, 5);  // too late
  expectPlace(placed({{}, 0, 1, 9}, {3, 3, 3, 3, 3, 3}), glm::vec3(0), 1, 0, 10);      // no longer inside
}

// By the clearance of 0.4 m towards where there is most room, unless that leads closer to the surface.
TEST(ProbeBlend, AProbeKeepsItsDistance) {
  expectPlace(placed({}, {0.1, 2, 3, 5, 3, 4}), {0, 0.4, 0}, 0, 0, 1);
  expectPlace(placed({}, {0.1, 0.2, 0.3, 0.3, 0.2, 0.35}), {0, 0, 0.35}, 0, 0, 1);
  expectPlace(placed({{0, 0.6f, 0}, 7, 0, 1}, {0.1, 2, 3, 5, 3, 4}), {0, 0.6, 0}, 8, 0,
              2);  // out of its cell
}

// As far as the clearance allows.
TEST(ProbeBlend, AProbeReturnsWhereThereIsRoom) {
  expectPlace(placed({{0.6f, 0, 0}, 7, 0, 1}, {0.7, 3, 3, 3, 3, 3}), {0.3, 0, 0}, 0, 0, 2);
  expectPlace(placed({{0.6f, 0, 0}, 7, 0, 1}, {2, 3, 3, 3, 3, 3}), {0, 0, 0}, 0, 0, 2);
  expectPlace(placed({{0.6f, 0, 0}, 7, 0, 1}, {0.41, 3, 3, 3, 3, 3}), {0.6, 0, 0}, 8, 0, 2);  // not worth it
}

}  // namespace
}  // namespace fovea::test
