// Clusters of neighbouring triangles of a draw run, each with a bounding sphere, so that clusters outside a view are
// not drawn.
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
  DrawKind kind = DrawKind::Transparent;
};

// Clusters of all static triangles of the runs, in their order, with at most `size` triangles each.
std::vector<DrawCluster> drawClusters(const std::vector<DrawRun>& runs, const Geometry& geometry,
                                      uint32_t size = 128);

// Collects the clusters that may be visible in a view, joined to runs, followed by the triangles that move. `visible`
// is overwritten; nothing is allocated once it has had room for all runs.
void visibleRuns(const std::vector<DrawCluster>& clusters, const std::vector<DrawRun>& runs,
                 uint32_t staticTriangles, const glm::mat4& worldToClip, std::vector<DrawRun>& visible);

}  // namespace fovea::scene
