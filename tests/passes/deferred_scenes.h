// What tests of pass deferred shade: a floor, bumpy patches, and VPLs above them.
#pragma once

#include <cmath>

#include "framework/base/random.h"
#include "tests/passes/deferred_reference.h"

namespace fovea::test {

inline float random(uint32_t what, uint32_t i) { return uniformFloat(randomStream(11, 0, what, i)); }

inline scene::Vpl makeVpl(glm::vec3 position, glm::vec3 normal, glm::vec3 intensity, float area = 0.1f) {
  scene::Vpl v;
  v.position = position;
  v.normal = glm::normalize(normal);
  v.intensity = intensity;
  v.area = area;
  return v;
}

// The rays of an eye above the origin onto a floor, `step` metres apart there.
inline scene::PixelRays floorRays(int width, int height, float step, float eyeDistance) {
  const glm::vec3 first(-0.5f * float(width - 1) * step, 0, -0.5f * float(height - 1) * step);
  return raysOnto({0, eyeDistance, 0}, first, {step, 0, 0}, {0, 0, step});
}

// A floor seen from above: pixels (x, y) around the origin, `step` metres apart.
inline GBuffer makeFloor(int width, int height, float step, float eyeDistance = 5) {
  return GBuffer(width, height, floorRays(width, height, step, eyeDistance), [&](int x, int y) {
    SurfacePixel p;
    p.position = {(float(x) - 0.5f * float(width - 1)) * step, 0,
                  (float(y) - 0.5f * float(height - 1)) * step};
    p.distance = 1;
    p.albedo = {0.25f, 0.5f, 0.75f};
    return p;
  });
}

// VPLs on a ceiling and walls around a floor of +-2 m.
inline std::vector<scene::Vpl> randomVpls(uint32_t count) {
  std::vector<scene::Vpl> list;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 position(4 * random(0, i) - 2, 1 + 2 * random(1, i), 4 * random(2, i) - 2);
    const glm::vec3 normal(random(3, i) - 0.5f, -1, random(4, i) - 0.5f);
    list.push_back(makeVpl(position, normal,
                           glm::vec3(random(5, i), random(6, i), random(7, i)) * 100.0f / float(count),
                           0.02f + random(8, i)));
  }
  return list;
}

// Patches at different depths, with holes between them.
inline GBuffer bumpyPatches(int width, int height) {
  return GBuffer(width, height, raysOnto({0, 4, 0}, {-0.5f, 0, -0.4f}, {0.02f, 0, 0}, {0, 0, 0.02f}),
                 [](int x, int y) {
                   const uint32_t patch = uint32_t(x / 9 + 8 * (y / 7)), pixel = uint32_t(x + 64 * y);
                   SurfacePixel p;
                   p.distance = random(30, patch) < 0.15f ? 0.0f : 3 + random(31, patch);
                   p.position = {0.02f * float(x) - 0.5f, random(32, patch) + 0.004f * random(33, pixel),
                                 0.02f * float(y) - 0.4f};
                   const auto tilt = [&](uint32_t k) {
                     return random(34 + k, patch) - 0.5f + 0.3f * (random(36 + k, pixel) - 0.5f);
                   };
                   p.normal = glm::normalize(glm::vec3(tilt(0), 1, tilt(1)));
                   p.albedo = {random(38, pixel), random(39, pixel), random(40, pixel)};
                   return p;
                 });
}

inline void expectImage(const std::vector<float>& image, const GBuffer& g,
                        const std::vector<glm::dvec3>& expected, double relative, size_t allowed = 0) {
  ASSERT_EQ(image.size(), g.pixels.size() * 4);
  size_t wrong = 0;
  for (size_t i = 0; i < g.pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      const double want = expected[i][int(c)], got = image[4 * i + c];
      if (std::abs(got - want) <= relative * std::abs(want) + 1e-5) continue;
      if (++wrong > allowed && wrong < allowed + 5)
        ADD_FAILURE() << "pixel " << i % size_t(g.width) << "," << i / size_t(g.width) << " channel " << c
                      << ": " << got << ", expected " << want;
    }
  EXPECT_LE(wrong, allowed);
}

}  // namespace fovea::test
