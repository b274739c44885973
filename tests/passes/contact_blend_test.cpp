// Tests which light a pixel gets: that of rays where there is some, else that of pass deferred.
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "fovea/test.h"

namespace fovea::test {
namespace {

TEST(ContactBlend, RaysWhereThereAreSome) {
  constexpr uint32_t kWidth = 5, kHeight = 4;
  std::vector<uint64_t> light, nearField, irradiance;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const bool found = i % 3 == 1;
    light.push_back(glm::packHalf4x16(found ? glm::vec4(i, 2, i == 7 ? 65504 : 1, 1) : glm::vec4(0)));
    nearField.push_back(glm::packHalf4x16({0.5f, i == 7 ? 60000 : 0.25f, 60, 16}));
    irradiance.push_back(glm::packHalf4x16({7, 8, 9 + i, 0}));
  }
  PassTest test("contact-blend");
  test.viewSize(kWidth, kHeight).param("longer", 3.0);
  const auto wire = [&](const char* port, const std::vector<uint64_t>& image) {
    test.image(port, VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, image);
  };
  wire("light", light);
  wire("near_field", nearField);
  wire("irradiance", irradiance);
  test.run();
  const auto got = test.values<uint64_t>("blended");
  for (uint32_t i = 0; i < got.size(); ++i) {
    const glm::vec4 found = glm::unpackHalf4x16(light[i]), near = glm::unpackHalf4x16(nearField[i]),
                    else_ = glm::unpackHalf4x16(irradiance[i]);
    const glm::vec4 want = found.a > 0 ? glm::vec4(glm::min(glm::vec3(found) + glm::vec3(near), 65504.0f), 3)
                                       : glm::vec4(glm::vec3(else_), 1);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(glm::unpackHalf4x16(got[i])[c], want[c], 1e-3f * want[c]) << i;
  }
}

}  // namespace
}  // namespace fovea::test
