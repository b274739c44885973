// VPLs of pass `emit` in a closed room.
#pragma once

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/support/shapes.h"

namespace fovea::test {

using scene::Vpl;
inline constexpr double kPi = glm::pi<double>();

inline scene::Scene room(glm::vec3 rho, float halfSize = 2) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, rho);
  const uint32_t materials[6] = {m, m, m, m, m, m};
  addRoom(s, materials, halfSize);
  return s;
}

inline std::vector<Vpl> emitted(PassTest& test, const scene::Scene& s) {
  test.viewSize(8, 8).scene(s);
  test.run();
  return test.values<Vpl>("vpls");
}

// Reflected flux of all VPLs in W: Phi = pi I for a diffuse emitter.
inline glm::dvec3 totalFlux(const std::vector<Vpl>& vpls) {
  glm::dvec3 sum(0);
  for (const Vpl& v : vpls) sum += kPi * glm::dvec3(v.intensity);
  return sum;
}

inline void expectFlux(const std::vector<Vpl>& vpls, glm::dvec3 expected, double tolerance) {
  const glm::dvec3 sum = totalFlux(vpls);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], tolerance * expected[c]) << "channel " << c;
}

inline int filled(const std::vector<Vpl>& vpls) {
  int n = 0;
  for (const Vpl& v : vpls) n += v.intensity != glm::vec3(0);
  return n;
}

}  // namespace fovea::test
