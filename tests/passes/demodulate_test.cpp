// Divides light by reflectance again on the CPU.
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "framework/base/random.h"
#include "tests/passes/deferred_reference.h"

namespace fovea::test {
namespace {

TEST(Demodulate, DividesLightByReflectance) {
  constexpr int kWidth = 19, kHeight = 11;
  const GBuffer seen(kWidth, kHeight, [](int x, int y) {
    SurfacePixel p;
    for (int c = 0; c < 3; ++c)
      p.albedo[c] = uniformFloat(randomStream(1, uint32_t(x), uint32_t(c), uint32_t(y)));
    if (x == 3) p.albedo = {0, 0.5f, 0};  // reflects no red and no blue
    return p;
  });
  std::vector<float> indirect;
  for (size_t i = 0; i < seen.pixels.size(); ++i)
    for (uint32_t c = 0; c < 4; ++c) indirect.push_back(3 * uniformFloat(randomStream(2, uint32_t(i), c, 0)));
  PassTest test("demodulate");
  seen.wire(test);
  test.image("indirect", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, indirect);
  test.run();
  const auto got = test.floats("irradiance");
  for (size_t i = 0; i < seen.pixels.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float rho = seen.pixels[i].albedo[int(c)];
      const float want = rho > 0 ? std::min(indirect[4 * i + c] / rho, 65504.0f) : 0;
      EXPECT_NEAR(got[4 * i + c], want, 1e-3f * want) << i << " " << c;
    }
    EXPECT_EQ(got[4 * i + 3], 1);
  }
}

}  // namespace
}  // namespace fovea::test
