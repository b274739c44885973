#include "framework/scene/device/draw_clusters.h"

#include <algorithm>
#include <array>

namespace fovea::scene {
namespace {

DrawCluster makeCluster(const Geometry& geometry, DrawKind kind, uint32_t first, uint32_t count) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (uint32_t i = first; i < first + count; ++i)
    for (const uint32_t v : geometry.triangles[i].v) {
      low = glm::min(low, geometry.positions[v]);
      high = glm::max(high, geometry.positions[v]);
    }
  return {0.5f * (low + high), 0.5f * glm::length(high - low), first, count, kind};
}

// Unit normals that point into the view volume.
std::array<glm::vec4, 6> viewPlanes(const glm::mat4& worldToClip) {
  const glm::mat4 rows = glm::transpose(worldToClip);
  std::array<glm::vec4, 6> planes{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                  rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
  for (glm::vec4& plane : planes) plane /= std::max(glm::length(glm::vec3(plane)), 1e-30f);
  return planes;
}

void append(std::vector<DrawRun>& runs, DrawKind kind, uint32_t first, uint32_t count) {
  if (!runs.empty() && runs.back().kind == kind &&
      runs.back().firstTriangle + runs.back().triangleCount == first)
    runs.back().triangleCount += count;
  else
    runs.push_back({kind, first, count});
}

}  // namespace

std::vector<DrawCluster> drawClusters(const std::vector<DrawRun>& runs, const Geometry& geometry,
                                      uint32_t size) {
  std::vector<DrawCluster> clusters;
  for (const DrawRun& run : runs) {
    const uint32_t end = std::min(run.firstTriangle + run.triangleCount, geometry.staticTriangles);
    for (uint32_t first = run.firstTriangle; first < end; first += size)
      clusters.push_back(makeCluster(geometry, run.kind, first, std::min(size, end - first)));
  }
  return clusters;
}

void visibleRuns(const std::vector<DrawCluster>& clusters, const std::vector<DrawRun>& runs,
                 uint32_t staticTriangles, const glm::mat4& worldToClip, std::vector<DrawRun>& visible) {
  visible.clear();
  visible.reserve(clusters.size() + runs.size());
  const std::array<glm::vec4, 6> planes = viewPlanes(worldToClip);
  for (const DrawCluster& c : clusters) {
    const float reach = c.radius * 1.0001f + 1e-5f * glm::length(c.centre);  // rounding
    const bool outside = std::any_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
      return glm::dot(glm::vec3(plane), c.centre) + plane.w < -reach;
    });
    if (!outside) append(visible, c.kind, c.firstTriangle, c.triangleCount);
  }
  for (const DrawRun& run : runs) {
    const uint32_t first = std::max(run.firstTriangle, staticTriangles),
                   end = run.firstTriangle + run.triangleCount;
    if (first < end) append(visible, run.kind, first, end - first);
  }
}

}  // namespace fovea::scene
