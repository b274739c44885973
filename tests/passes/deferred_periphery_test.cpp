// Tests shading with one pixel in each square of 2 x 2 outside the fovea, against the CPU.
#include <gtest/gtest.h>

#include "fovea/error.h"
#include "passes/acuity.h"
#include "tests/passes/deferred_scenes.h"

namespace fovea::test {
namespace {

// A fovea of 8 pixels around the gaze, in a picture so large that the eye resolves little outside.
void setFovea(PassTest& test, const GBuffer& g, glm::vec2 gaze) {
  test.param("periphery", 2).view("pixels_per_degree", 200.0).view("fovea_radius", 8.0 / g.width);
  test.beforeFrame([gaze](PassTest&, scene::Frame& f) { f.views[0].gaze = gaze; });
}

passes::Square fineSquare(const GBuffer& g, glm::vec2 gaze) {
  scene::View view;
  view.size = {g.width, g.height};
  view.gaze = gaze;
  view.foveaRadius = 8.0f / float(g.width);
  view.pixelsPerDegree = 200;
  return passes::fullDensity(view, 16);
}

bool isInside(const passes::Square& square, int x, int y) {
  return x >= square.low.x && y >= square.low.y && x < square.high.x && y < square.high.y;
}

// The reference is the fine picture within the square, and the coarse one outside.
TEST(DeferredPeriphery, EqualsTheReference) {
  const GBuffer g = bumpyPatches(90, 75);
  const auto vpls = randomVpls(300);
  for (const int n : {1, 2, 4, 8})
    for (const glm::vec2 gaze : {glm::vec2(0.5f), glm::vec2(0.9f, 0.1f), glm::vec2(-3, 2)}) {
      DeferredReference reference;
      reference.interleave = n;
      const auto fine = reference.irradiance(g, vpls);
      auto want = reference.coarseIrradiance(g, vpls);
      const passes::Square square = fineSquare(g, gaze);
      int inside = 0;
      for (int y = 0; y < g.height; ++y)
        for (int x = 0; x < g.width; ++x)
          if (isInside(square, x, y)) {
            want[size_t(y * g.width + x)] = fine[size_t(y * g.width + x)];
            ++inside;
          }
      EXPECT_EQ(inside > 0, gaze.x >= 0);
      EXPECT_LT(inside, g.width * g.height / 2);
      PassTest test("deferred");
      setFovea(test, g, gaze);
      g.wire(test);
      test.buffer("vpls", vpls, "Vpl").param("interleave", n);
      test.run();
      SCOPED_TRACE(n);
      expectImage(test.floats("irradiance"), g, want, 0.01, g.pixels.size() * 3 / 100);
    }
}

// What the eye resolves is the same to the bit as without a periphery, and elsewhere on a floor the coarse grid is
// good enough; a quarter of the pixels there is shaded.
TEST(DeferredPeriphery, SparesWorkOnlyWhereTheEyeSeesLittle) {
  const GBuffer g = makeFloor(128, 96, 0.03f);
  const auto vpls = randomVpls(400);
  const glm::vec2 gaze(0.4f, 0.5f);
  const auto irradiance = [&](bool periphery, double& shaded) {
    PassTest test("deferred");
    if (periphery) setFovea(test, g, gaze);
    g.wire(test);
    test.buffer("vpls", vpls, "Vpl").param("kernel", "disc");
    test.run();
    shaded = test.counter("shaded_pixels");
    return test.floats("irradiance");
  };
  double all = 0, few = 0;
  const auto full = irradiance(false, all), spared = irradiance(true, few);
  const passes::Square square = fineSquare(g, gaze);
  double error = 0, sum = 0;
  int inside = 0;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      const size_t at = 4 * size_t(y * g.width + x);
      if (isInside(square, x, y)) {
        ++inside;
        ASSERT_EQ(spared[at], full[at]) << x << ", " << y;
      } else {
        error += std::abs(spared[at] - full[at]);
        sum += full[at];
      }
    }
  EXPECT_EQ(all, g.width * g.height);
  EXPECT_EQ(few, inside + (g.width * g.height - inside) / 4);
  EXPECT_LT(error, 0.03 * sum);
}

TEST(DeferredPeriphery, NotWithAMaskOfBlocks) {
  const GBuffer g = makeFloor(16, 16, 0.1f);
  PassTest test("deferred");
  g.wire(test);
  test.param("periphery", 2).buffer("vpls", randomVpls(16), "Vpl");
  test.image("base", VK_FORMAT_R16G16B16A16_SFLOAT, 16, 16, 1, std::vector<uint16_t>(16 * 16 * 4));
  test.image("shade.mask", VK_FORMAT_R8_UNORM, 16, 16, 1, std::vector<uint8_t>(16 * 16));
  test.buffer("shade.blocks", std::vector<uint32_t>(16), "ShadeBlock");
  test.buffer("shade.dispatch", std::vector<glm::uvec4>(1), "ShadeDispatch");
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("`periphery`"), std::string::npos) << e.what();
  }
}

// In a view of 60 degrees and 1024 pixels, 17 pixels make a degree; periods of 4 of them are all that is resolved at an
// eccentricity of (0.234 - 1/48) / 0.022 = 9.7 degrees, or 165 pixels.
TEST(DeferredPeriphery, FollowsAcuity) {
  scene::View view;
  view.size = {1024, 1024};
  view.verticalFov = glm::radians(60.0f);
  view.gaze = {0.5f, 0.25f};
  view.foveaRadius = 0.01f;
  const passes::Square byEye = passes::fullDensity(view, 1);
  EXPECT_NEAR(512 - byEye.low.x, 165, 2);
  EXPECT_NEAR(byEye.high.y - 256, 165, 2);
  view.foveaRadius = 0.25f;
  const passes::Square byFovea = passes::fullDensity(view, 16);
  EXPECT_EQ(byFovea.low, glm::ivec2(256, 0));
  EXPECT_EQ(byFovea.high, glm::ivec2(768, 512));
  view.foveaRadius = 0.01f;
  view.pixelsPerDegree = 1000;
  EXPECT_EQ(passes::fullDensity(view, 16).high, glm::ivec2(528, 272));
}

}  // namespace
}  // namespace fovea::test
