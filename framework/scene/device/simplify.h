// A coarser mesh of the static scene, for shadows that need not be exact.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct SimplifiedMesh {
  // Three corners a triangle, xyz in world space (m). w of a triangle's first corner: 0, or 1 + the index of
  // the scene triangle it is, whose material has holes.
  std::vector<glm::vec4> corners;
  uint32_t sourceTriangles = 0;  // static triangles it stands for
  float error = 0;               // about how far its surface strays from the scene's, m
  uint32_t triangles() const { return uint32_t(corners.size() / 3); }
};

// Collapses edges of the opaque static triangles, welded by position, until `ratio` of them is left (quadric
// error metric of meshoptimizer; closed surfaces with little to collapse may keep more). Triangles of
// alpha-masked materials stay as they are: their texture coordinates carry the holes. `ratio` from 0 to 1; 1
// keeps every triangle. Throws Error(BadInput) when a masked triangle's index does not fit (2^24).
SimplifiedMesh simplify(const Scene& scene, const Geometry& geometry, float ratio);

}  // namespace fovea::scene
