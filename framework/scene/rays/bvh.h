// A bounding volume hierarchy over triangles, in which rays are traced on devices and, in portable bundles, on the
// host (shaders/rays/bvh.glsl).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
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
  std::vector<uint32_t> order;  // indices into Geometry::triangles
};

// By the binned surface area heuristic (Wald 2007).
Bvh buildBvh(const Geometry& geometry, TriangleRange range = {});

// An order in which the boxes of a tree can be computed again after its triangles have moved: in rounds, of which each
// works on many parts of the tree at once, and on the nodes of a part one after the other.
struct RefitOrder {
  // Part by part. The children of a node come before it in its part, or belong to an earlier round.
  std::vector<uint32_t> nodes;
  std::vector<uint32_t> parts;   // first element of `nodes` of each part, then the number of nodes
  std::vector<uint32_t> rounds;  // first part of each round, then the number of parts
};

// Parts are as large as `nodesPerPart`, which is at least 1, allows.
RefitOrder refitOrder(const Bvh& bvh, uint32_t nodesPerPart);

// Trees as shaders/rays/bvh.glsl reads them.
struct BvhTables {
  std::vector<BvhNode> nodes;
  std::vector<glm::uvec4> triangles;  // vertices, triangle and kRayHoles

  BvhTables();
  // The root of the tree takes the place `top`, kBvhStill or kBvhMoving; all other nodes follow those that are there.
  // hasHoles: whether a triangle may have any. Returns the place that the second node of the tree would have if the
  // first were not elsewhere.
  uint32_t add(const Bvh& bvh, uint32_t top, const Geometry& geometry,
               const std::function<bool(uint32_t triangle)>& hasHoles);
};

}  // namespace fovea::scene
