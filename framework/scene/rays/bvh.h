// A bounding volume hierarchy over triangles, in which rays are traced on the host in portable bundles
// (ray_tracer_bvh.cpp) and on the device (shaders/rays/trace.glsl).
#pragma once

#include <cstdint>
#include <vector>

#include "framework/scene/scene.h"
#include "shaders/records/rays.h"

namespace fovea::scene {

// Triangles [first, end) of a geometry.
struct TriangleRange {
  uint32_t first = 0, end = ~0u;
};

struct Bvh {
  // Level by level: the root, its children, their children. The two children of a node are adjacent. A leaf's entries
  // are those of `order`. A tree without triangles is one empty leaf.
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> levels;  // first node of each level, then the number of nodes
  std::vector<uint32_t> order;   // indices into Geometry::triangles
};

// By the binned surface area heuristic (Wald 2007).
Bvh buildBvh(const Geometry& geometry, TriangleRange range = {});

}  // namespace fovea::scene
