// A furnace with a closed form for whole graphs.
#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/scene/scene.h"
#include "tests/support/shapes.h"

namespace fovea::test {

// Inside a closed diffuse sphere every point sees every other with the same form factor, so the light I / R^2 from its
// centre comes back evenly as I / R^2 (rho + rho^2 + ...).
constexpr float kSphereRadius = 20, kSphereCandela = 100;

// The sphere with a lamp in its middle, and a camera inside.
inline scene::Scene litSphere(float rho) {
  scene::Scene s;
  addMaterial(s, glm::vec3(rho));
  addHollowSphere(s, 0, glm::vec3(0), kSphereRadius, 64, 32);
  s.lights = {pointLight(glm::vec3(0), glm::vec3(kSphereCandela))};
  s.cameras.emplace_back();
  s.cameras[0].position = {0, 0, 15};
  s.cameras[0].verticalFov = 1.5f;
  return s;
}

// Its indirect radiance after this many bounces, W/(sr m^2).
inline double litSphereRadiance(float rho, int bounces) {
  double series = 0;
  for (int k = 1; k <= bounces; ++k) series += std::pow(double(rho), k);
  return double(rho) / glm::pi<double>() * double(kSphereCandela / (kSphereRadius * kSphereRadius)) * series;
}

}  // namespace fovea::test
