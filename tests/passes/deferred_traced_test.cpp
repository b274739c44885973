// Tests that the light found by rays replaces the filtered light.
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "tests/passes/deferred_scenes.h"

namespace fovea::test {
namespace {

constexpr float kLonger = 3;  // what `traced` says of the length of a mean

std::vector<uint64_t> image(const GBuffer& g, auto&& valueAt) {
  std::vector<uint64_t> result;
  for (uint32_t i = 0; i < g.pixels.size(); ++i) result.push_back(glm::packHalf4x16(valueAt(i)));
  return result;
}

// Every third pixel that shows a surface; at one, the sum exceeds what half a float can hold.
glm::vec4 tracedAt(const GBuffer& g, uint32_t i) {
  if (i % 3 != 1 || g.pixels[i].distance == 0) return glm::vec4(0);
  return {float(i % 50), 2, i % 7 == 0 ? 65504 : 1, kLonger};
}

glm::vec4 nearFieldAt(uint32_t i) { return {0.5f, i % 7 == 0 ? 0.25f : 0.75f, 60000, 1}; }

std::vector<uint64_t> irradiance(const GBuffer& g, bool traced, bool nearField, int periphery = 1) {
  PassTest test("deferred");
  g.wire(test);
  const auto wire = [&](const char* port, const std::vector<uint64_t>& values) {
    test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, uint32_t(g.width), uint32_t(g.height), 1, values);
  };
  if (traced) wire("traced", image(g, [&](uint32_t i) { return tracedAt(g, i); }));
  if (nearField) wire("near_field", image(g, nearFieldAt));
  test.buffer("vpls", randomVpls(100), "Vpl");
  test.param("periphery", periphery).view("pixels_per_degree", 200.0).view("fovea_radius", 8.0 / g.width);
  test.run();
  return test.values<uint64_t>("irradiance");
}

TEST(DeferredTraced, TakesThePlaceOfTheFilter) {
  const GBuffer g = bumpyPatches(70, 45);
  for (const bool nearField : {false, true}) {
    const auto without = irradiance(g, false, nearField), with = irradiance(g, true, nearField);
    size_t found = 0;
    for (uint32_t i = 0; i < with.size(); ++i) {
      const glm::vec4 traced = tracedAt(g, i), got = glm::unpackHalf4x16(with[i]);
      if (traced.a == 0) {
        ASSERT_EQ(with[i], without[i]) << i;
        continue;
      }
      ++found;
      const glm::vec3 near = nearField ? glm::vec3(nearFieldAt(i)) : glm::vec3(0);
      const glm::vec4 want(glm::min(glm::vec3(traced) + near, 65504.0f), kLonger);
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(got[c], want[c], 1e-3f * want[c]) << i;
    }
    EXPECT_GT(found, with.size() / 6);
  }
}

TEST(DeferredTraced, IsNotUsedInThePeriphery) {
  const GBuffer g = makeFloor(128, 96, 0.03f);
  const auto without = irradiance(g, false, false, 2), with = irradiance(g, true, false, 2);
  EXPECT_NE(with[size_t(48 * g.width + 64)], without[size_t(48 * g.width + 64)]);
  for (size_t i = 0; i < size_t(32 * g.width); ++i) ASSERT_EQ(with[i], without[i]) << i;
}

}  // namespace
}  // namespace fovea::test
