// An environment map, and the light that it sends to a surface in the open.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <vector>

#include "framework/scene/environment/environment_map.h"

namespace fovea::test {

// Brighter towards the zenith and in the east, dark below the horizon, with a small sun.
inline std::shared_ptr<const scene::EnvironmentMap> skyWithSun() {
  constexpr uint32_t kWidth = 32, kHeight = 16;
  std::vector<glm::vec3> texels;
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      const float up = 1 - 2 * float(y) / kHeight, east = float(x) / kWidth;
      texels.push_back(up > 0 ? glm::vec3(0.2f, 0.4f, 1) * (0.5f + up + east) : glm::vec3(0.05f));
    }
  texels[5 * kWidth + 20] = glm::vec3(300, 250, 200);
  return std::make_shared<const scene::EnvironmentMap>(kWidth, kHeight, std::move(texels), 0.7f);
}

// W/m^2 on a surface that faces along `normal`, by a sum over directions that lie evenly.
inline glm::dvec3 irradianceFrom(const scene::EnvironmentMap& map, glm::vec3 normal) {
  constexpr int kSide = 512;
  glm::dvec3 sum(0);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < 2 * kSide; ++i) {
      const double y = 1 - 2 * (j + 0.5) / kSide, phi = (i + 0.5) / kSide * glm::pi<double>();
      const double across = std::sqrt(1 - y * y);
      const glm::vec3 direction(across * std::sin(phi), y, across * std::cos(phi));
      sum += std::max(0.0, double(glm::dot(direction, normal))) * glm::dvec3(map.radiance(direction));
    }
  return sum * (4 * glm::pi<double>() / (2.0 * kSide * kSide));
}

}  // namespace fovea::test
