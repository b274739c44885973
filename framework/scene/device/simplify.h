// Makes a coarser mesh of the static scene, for shadows that need not be exact.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct SimplifiedMesh {
  // Three corners per triangle, xyz in world space (m). w of the first corner is 0 or, for a triangle whose material
  // has holes, 1 + the index of the scene's triangle.
  std::vector<glm::vec4> corners;
  uint32_t sourceTriangles = 0;  // number of static triangles that it replaces
  float error = 0;               // approximate distance of its surface from the scene's, m
  uint32_t triangles() const { return uint32_t(corners.size() / 3); }
};

// Collapses edges of the opaque static triangles, welded by position, until the share `ratio` of them is left
// (quadric error metric of meshoptimizer; closed surfaces with little to collapse may keep more). Triangles of
// alpha-masked materials stay as they are because their texture coordinates define the holes. `ratio` is from 0 to 1;
// 1 keeps every triangle. Throws Error(BadInput) if the index of a masked triangle does not fit (2^24).
SimplifiedMesh simplify(const Scene& scene, const Geometry& geometry, float ratio);

}  // namespace fovea::scene
