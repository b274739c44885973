// Triangles and directions for tests that compare tracers of rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "framework/base/random.h"
#include "framework/scene/scene.h"

namespace fovea::test {

// Components in [-1, 1).
inline glm::vec3 randomVector(uint32_t i, uint32_t what) {
  const auto u = [&](uint32_t k) { return 2 * uniformFloat(randomStream(3, what, k, i)) - 1; };
  return {u(0), u(1), u(2)};
}

// Triangles from tiny to large, with vertices on a grid, so that rays meet edges, corners and flat boxes. Three
// materials take turns.
inline scene::Geometry raySoup(uint32_t count) {
  scene::Geometry g;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 centre = 5.0f * randomVector(i, 0);
    const float size = i % 10 == 0 ? 2.0f : 0.3f;
    for (uint32_t k = 0; k < 3; ++k) {
      glm::vec3 p = centre + size * randomVector(i, 1 + k);
      if (i % 3 == 0) p = glm::round(p * 2.0f) / 2.0f;
      g.positions.push_back(p);
      g.normals.emplace_back(0, 1, 0);
      g.uvs.emplace_back(k == 1, k == 2);
    }
    g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, i % 3});
  }
  g.boundsMin = glm::vec3(-6);
  g.boundsMax = glm::vec3(6);
  g.staticTriangles = count;
  return g;
}

}  // namespace fovea::test
