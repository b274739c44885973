// Compares the light of probes at surfaces with the formula in double precision.
#include <gtest/gtest.h>

#include <algorithm>

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

// Points in the grid, a few of them beyond it, and a row of background.
GBuffer points(glm::vec3 eye) {
  Numbers numbers(5);
  const glm::vec3 right(2.6f / kWidth, 0, 0), down(0, -2.1f / kHeight, 0);
  const scene::PixelRays rays = raysOnto(eye, {-1.3f, 1.3f, -3}, right, down);
  return {kWidth, kHeight, rays, [&](int x, int y) {
            SurfacePixel p;
            p.position =
                glm::vec3(-1.3f, 1.3f, numbers.next(-4.3f, -1.7f)) + float(x) * right + float(y) * down;
            p.normal = numbers.direction();
            p.distance = y == 4 ? 0.0f : 1.0f;
            return p;
          }};
}

TEST(ProbeSample, LightOfTheProbesThatSeeThePoint) {
  const Probes probes = knownProbes(kProbes, kSpacing);
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
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const SurfacePixel& p = g.pixels[size_t(i)];
        const glm::vec3 normal = glm::normalize(p.normal), towardsEye = glm::normalize(eye - p.position);
        const glm::dvec3 want =
            p.distance > 0 ? probeLight(grid, probes, p.position, normal, towardsEye, bias) : glm::dvec3(0);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[size_t(4 * i + c)], want[c], 2e-3 * want[c]) << i;
      }
    }
  }
}

// Where all probes around a point are inside geometry there is no light, and no division by 0.
TEST(ProbeSample, NoProbeIsLeft) {
  Probes probes = knownProbes(kProbes, kSpacing);
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
