// Compares the light that reservoirs stand for with the plain formula.
#include <gtest/gtest.h>

#include "tests/passes/reservoir_reference.h"

namespace fovea::test {
namespace {

constexpr int kWidth = 19, kHeight = 11;

TEST(ReservoirsResolve, RadianceTimesCosineTimesWeight) {
  Numbers numbers;
  GBuffer g(kWidth, kHeight, raysOnto({0, 0, 0}, {0, 0, -5}, {1, 0, 0}, {0, 1, 0}), [&](int x, int y) {
    SurfacePixel p;
    p.position = {float(x), float(y), -5};
    p.distance = y == 3 ? 0.0f : 5.0f;
    p.normal = glm::normalize(glm::vec3(numbers.next() - 0.5f, numbers.next() - 0.5f, 1));
    return p;
  });
  std::vector<Reservoir> reservoirs;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    Reservoir r;
    r.position = {20 * numbers.next(), 12 * numbers.next(), 8 * numbers.next() - 6};
    r.radiance = {numbers.next(), 10 * numbers.next(), i == 40 ? 1e9f : numbers.next()};
    r.weight = i % 5 == 2 ? 0.0f : 4 * numbers.next();
    r.count = 1;
    reservoirs.push_back(i % 13 == 1 ? Reservoir{} : r);
  }
  PassTest test("reservoirs-resolve");
  g.wire(test);
  test.buffer("reservoirs", reservoirs, "Reservoir");
  test.run();
  const auto light = test.floats("irradiance");
  int lit = 0, behind = 0;
  for (size_t i = 0; i < reservoirs.size(); ++i) {
    const Reservoir& r = reservoirs[i];
    const double cosine = cosineAt(g.pixels[i], r);
    const bool shown = g.pixels[i].distance > 0 && r.weight > 0;
    for (size_t c = 0; c < 3; ++c) {
      const double want =
          shown ? std::min(r.radiance[int(c)] * cosine * r.weight / glm::pi<double>(), 65504.0) : 0;
      EXPECT_NEAR(light[4 * i + c], want, 2e-3 * want + 1e-6) << i;
    }
    lit += shown && cosine > 0;
    behind += shown && cosine == 0;
  }
  EXPECT_GT(lit, 80);
  EXPECT_GT(behind, 3);
}

}  // namespace
}  // namespace fovea::test
