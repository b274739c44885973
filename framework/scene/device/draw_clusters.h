// Neighbouring triangles of a draw run under one bounding sphere, so that what lies outside a view is not
// drawn.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/device/draw_runs.h"

namespace fovea::scene {

struct DrawCluster {
  glm::vec3 centre{0};  // world space
  float radius = 0;
  uint32_t firstTriangle = 0, triangleCount = 0;
  DrawKind kind = DrawKind::Tested;
};

// All triangles of the runs that never move, at most `size` in a cluster, in their order.
std::vector<DrawCluster> drawClusters(const std::vector<DrawRun>& runs, const Geometry& geometry,
                                      uint32_t size = 128);

// The clusters that may show in a view, joined to runs; then the triangles that move. `visible` is
// overwritten, without an allocation once it has had room for all of them.
void visibleRuns(const std::vector<DrawCluster>& clusters, const std::vector<DrawRun>& runs,
                 uint32_t staticTriangles, const glm::mat4& worldToClip, std::vector<DrawRun>& visible);

}  // namespace fovea::scene
