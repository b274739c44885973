// Compares the light of probes at surfaces with the formula in double precision, on the device and on the CPU.
#include <gtest/gtest.h>

#include <algorithm>

#include "passes/probe-rays/probe_field.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/probe_reference.h"

namespace fovea::test {
namespace {

constexpr int kWidth = 37, kHeight = 13, kProbes = 90;
constexpr float kSpacing = 0.5f;

scene::ProbeGrid gridOf(uint32_t columns, uint32_t rows, uint32_t layers) {
  scene::ProbeGrid grid;
  grid.origin = {-1, -0.5f, -4};
  grid.spacing = kSpacing;
  grid.columns = columns;
  grid.rows = rows;
  grid.layers = layers;
  return grid;
}

// Light of every colour, distances of which some hide a point and some do not, and one probe of seven inside geometry.
Probes knownProbes() {
  Probes probes(kProbes);
  Numbers numbers(3);
  for (glm::vec4& t : probes.irradiance) t = {numbers.next(), 2 * numbers.next(), 4 * numbers.next(), 1};
  for (glm::vec2& t : probes.distance) {
    t.x = numbers.next(0.1f, 0.9f);
    t.y = t.x * t.x + numbers.next(0.001f, 0.05f);
  }
  for (size_t i = 0; i < kProbes; ++i) {
    probes.states[i].offset =
        0.4f * kSpacing * (glm::vec3(numbers.next(), numbers.next(), numbers.next()) - 0.5f);
    probes.states[i].inside = i % 7 == 3 ? 1.0f : 0.0f;
  }
  return probes;
}

template <class Texel>
glm::dvec4 bilinear(const std::vector<Texel>& image, const ProbeTiles& tiles, int probe,
                    glm::dvec3 direction) {
  const glm::dvec2 e(octEncode(glm::vec3(direction)));
  const glm::dvec2 place = (0.5 * e + 0.5) * double(tiles.side) - 0.5;
  glm::dvec4 sum(0);
  for (int k = 0; k < 4; ++k) {
    const glm::ivec2 p = glm::ivec2(glm::floor(place)) + glm::ivec2(k & 1, k >> 1);
    const glm::dvec2 near = 1.0 - glm::abs(place - glm::dvec2(p));
    const Texel& texel = image[tiles.at(probe, p.x, p.y)];
    for (int c = 0; c < int(Texel::length()); ++c) sum[c] += near.x * near.y * double(texel[c]);
  }
  return sum;
}

glm::dvec3 expected(const scene::ProbeGrid& grid, const Probes& probes, glm::dvec3 position,
                    glm::dvec3 normal, glm::dvec3 towardsEye, double bias) {
  const double spacing = grid.spacing;
  const glm::dvec3 moved = position + bias * spacing * (0.2 * normal + 0.8 * towardsEye);
  const int counts[3] = {int(grid.columns), int(grid.rows), int(grid.layers)};
  glm::dvec3 sum(0);
  double weights = 0;
  for (int probe = 0; probe < counts[0] * counts[1] * counts[2]; ++probe) {
    const int cell[3] = {probe % counts[0], probe / counts[0] % counts[1], probe / counts[0] / counts[1]};
    double weight = 1;
    glm::dvec3 centre;
    bool near = true;
    for (int k = 0; k < 3; ++k) {
      centre[k] = double(grid.origin[k]) + spacing * cell[k];
      const double last = counts[k] - 1,
                   place = std::clamp((moved[k] - double(grid.origin[k])) / spacing, 0.0, last);
      const double first = std::min(std::floor(place), std::max(last - 1, 0.0));
      near = near && (cell[k] == first || cell[k] == first + 1);
      weight *= 1 - std::abs(place - cell[k]);
    }
    const scene::Probe& state = probes.states[size_t(probe)];
    if (!near || state.inside > 0) continue;
    const glm::dvec3 stands = centre + glm::dvec3(state.offset);
    const double facing = (glm::dot(glm::normalize(stands - position), normal) + 1) / 2;
    const double distance = glm::distance(moved, stands);
    const glm::dvec4 seen =
        bilinear(probes.distance, probes.distanceTiles, probe, (moved - stands) / distance);
    double chance = 1;
    if (distance > seen.x) {
      const double variance = std::abs(seen.y - seen.x * seen.x);
      chance = std::max(std::pow(variance / (variance + std::pow(distance - seen.x, 2)), 3), 0.05);
    }
    double other = (facing * facing + 0.2) * chance;
    if (other < 0.2) other *= other * other / 0.04;
    weight = std::max(weight, 1e-6) * other;
    sum += weight * glm::dvec3(bilinear(probes.irradiance, probes.irradianceTiles, probe, normal));
    weights += weight;
  }
  return weights > 0 ? sum / weights : glm::dvec3(0);
}

// Points in the grid, a few of them beyond it, and a row of background.
GBuffer points(glm::vec3 eye) {
  Numbers numbers(5);
  std::vector<SurfacePixel> pixels;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    SurfacePixel p;
    p.position = {numbers.next(-1.3f, 1.3f), numbers.next(-0.8f, 1.3f), numbers.next(-4.3f, -1.7f)};
    p.normal = numbers.direction();
    p.distance = i / kWidth == 4 ? 0.0f : glm::distance(p.position, eye);
    pixels.push_back(p);
  }
  return {kWidth, kHeight, [&](int x, int y) { return pixels[size_t(y * kWidth + x)]; }};
}

TEST(ProbeSample, LightOfTheProbesThatSeeThePoint) {
  const Probes probes = knownProbes();
  for (const glm::uvec3 counts : {glm::uvec3(5, 3, 6), glm::uvec3(1, 4, 1)}) {
    const scene::ProbeGrid grid = gridOf(counts.x, counts.y, counts.z);
    const glm::vec3 eye(0, 0, 5);  // of the default camera
    const GBuffer g = points(eye);
    for (const double bias : {0.25, 0.8}) {
      PassTest test("probe-sample");
      g.wire(test);
      test.buffer("rays.grid", std::vector{grid}, "ProbeGrid");
      probes.wire(test, "probes");
      test.param("bias", bias).run();
      ASSERT_LT(glm::distance(test.lastFrame().views[0].eye, eye), 1e-6f);
      const auto got = test.floats("irradiance");
      const passes::ProbeField field(grid, {probes.irradiance, probes.distance, probes.states}, float(bias));
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const SurfacePixel& p = g.pixels[size_t(i)];
        const glm::vec3 normal = glm::normalize(p.normal), towardsEye = glm::normalize(eye - p.position);
        const glm::dvec3 want =
            p.distance > 0 ? expected(grid, probes, p.position, normal, towardsEye, bias) : glm::dvec3(0);
        const glm::vec3 onHost = field.light(p.position, normal, towardsEye);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(got[size_t(4 * i + c)], want[c], 2e-3 * want[c]) << i;
          if (p.distance > 0) EXPECT_NEAR(onHost[c], want[c], 1e-3 * want[c]) << i;
        }
      }
    }
  }
}

// Where all probes around a point are inside geometry there is no light, and no division by 0.
TEST(ProbeSample, NoProbeIsLeft) {
  Probes probes = knownProbes();
  for (scene::Probe& p : probes.states) p.inside = 1;
  const GBuffer g = points(glm::vec3(0));
  PassTest test("probe-sample");
  g.wire(test);
  test.buffer("rays.grid", std::vector{gridOf(5, 3, 6)}, "ProbeGrid");
  probes.wire(test, "probes");
  test.run();
  const auto got = test.floats("irradiance");
  for (size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i], i % 4 == 3 ? 1.0f : 0.0f) << i;
}

}  // namespace
}  // namespace fovea::test
