// Cameras of tests, and the surfaces that they see.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/tables/blocks.h"

namespace fovea::test {

// The rays from an eye whose first pixel sees the point `first`, and its neighbours the points `right` and `down` of it;
// world space, m.
inline scene::PixelRays raysOnto(glm::vec3 eye, glm::vec3 first, glm::vec3 right, glm::vec3 down) {
  scene::PixelRays rays;
  rays.eye = eye;
  rays.corner = first - 0.5f * (right + down) - eye;
  rays.right = right;
  rays.down = down;
  return rays;
}

// The point on the ray of a pixel at a distance from the eye, m.
inline glm::vec3 pointOn(const scene::PixelRays& rays, int x, int y, float distance) {
  const glm::vec3 ray = rays.corner + (float(x) + 0.5f) * rays.right + (float(y) + 0.5f) * rays.down;
  return rays.eye + distance * glm::normalize(ray);
}

// Distances from the eye. surfaces: xyz: positions, which have to lie on the rays; w: 0 in the background.
inline std::vector<float> distancesOf(const scene::PixelRays& rays, int width,
                                      const std::vector<glm::vec4>& surfaces) {
  std::vector<float> distances;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const glm::vec3 position(surfaces[i]);
    const float distance = surfaces[i].w > 0 ? glm::distance(position, rays.eye) : 0.0f;
    distances.push_back(distance);
    if (!(distance > 0)) continue;
    const glm::vec3 onRay = pointOn(rays, int(i) % width, int(i) / width, distance);
    EXPECT_LT(glm::distance(position, onRay), 1e-4f * distance + 1e-6f)
        << "pixel " << i << " is not on its ray";
  }
  return distances;
}

// Wires the members `distance` and `camera` of a G-buffer, those that the pass reads.
inline void wireSurfaces(PassTest& test, const std::string& port, const scene::PixelRays& rays, int width,
                         int height, const std::vector<float>& distances) {
  for (const graph::MemberSpec& m : test.declaration().findPort(port)->members) {
    if (m.name == "distance")
      test.image(port + ".distance", VK_FORMAT_R32_SFLOAT, uint32_t(width), uint32_t(height), 1, distances);
    if (m.name == "camera") test.buffer(port + ".camera", std::vector{rays}, "PixelRays");
  }
}
inline void wireSurfaces(PassTest& test, const std::string& port, const scene::PixelRays& rays, int width,
                         int height, const std::vector<glm::vec4>& surfaces) {
  wireSurfaces(test, port, rays, width, height, distancesOf(rays, width, surfaces));
}

// The surfaces in a G-buffer that a test has as output. xyz: positions, world space, m; w: distances, m, 0 in the
// background.
inline std::vector<glm::vec4> surfacesOf(const PassTest& test, const std::string& port, int width) {
  const scene::PixelRays rays = test.values<scene::PixelRays>(port + ".camera")[0];
  const std::vector<float> distances = test.values<float>(port + ".distance");
  std::vector<glm::vec4> surfaces;
  for (size_t i = 0; i < distances.size(); ++i)
    surfaces.emplace_back(pointOn(rays, int(i) % width, int(i) / width, distances[i]), distances[i]);
  return surfaces;
}

}  // namespace fovea::test
