#include "framework/scene/rays/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace fovea::scene {
namespace {

constexpr uint32_t kBins = 16;
// Below it, halves: with the 24 levels that flatten()'s 2^26 triangles then need, the tree stays below kBvhDepth.
constexpr uint32_t kMaxHeuristicDepth = 40;
static_assert(kMaxHeuristicDepth + 26 - std::countr_zero(kBvhLeaf) < kBvhDepth);

struct Box {
  glm::vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};
  void grow(glm::vec3 p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void grow(const Box& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
  float area() const {
    const glm::vec3 d = glm::max(hi - lo, glm::vec3(0));
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

class Builder {
 public:
  Builder(const Geometry& geometry, TriangleRange range) {
    const uint32_t end = std::min(range.end, uint32_t(geometry.triangles.size()));
    first_ = std::min(range.first, end);
    boxes_.resize(end - first_);
    for (uint32_t t = first_; t < end; ++t)
      for (const uint32_t v : geometry.triangles[t].v) boxes_[t - first_].grow(geometry.positions[v]);
    order_.resize(boxes_.size());
    std::iota(order_.begin(), order_.end(), 0u);
  }

  Bvh build() {
    Bvh bvh;
    bvh.nodes.push_back(leaf(0, uint32_t(order_.size())));
    for (uint32_t begin = 0, end = 1, depth = 0; begin < end; ++depth) {
      for (uint32_t i = begin; i < end; ++i) divide(bvh.nodes, i, depth);
      begin = end;
      end = uint32_t(bvh.nodes.size());
    }
    for (uint32_t& t : order_) t += first_;
    bvh.order = std::move(order_);
    return bvh;
  }

 private:
  // A node begins as a leaf of a part of the order. If that is too long, two nodes with a part of it each are added.
  void divide(std::vector<BvhNode>& nodes, uint32_t index, uint32_t depth) {
    const uint32_t begin = nodes[index].first, end = begin + nodes[index].count;
    if (end - begin <= kBvhLeaf) return;
    const uint32_t middle = split(begin, end, depth);
    nodes[index].first = uint32_t(nodes.size());
    nodes[index].count = 0;
    nodes.push_back(leaf(begin, middle));
    nodes.push_back(leaf(middle, end));
  }

  BvhNode leaf(uint32_t begin, uint32_t end) const {
    Box box;
    for (uint32_t i = begin; i < end; ++i) box.grow(boxes_[order_[i]]);
    return {box.lo, begin, box.hi, end - begin};
  }

  glm::vec3 centre(uint32_t t) const { return 0.5f * (boxes_[t].lo + boxes_[t].hi); }

  // Partitions [begin, end) into two parts and returns the start of the second.
  uint32_t split(uint32_t begin, uint32_t end, uint32_t depth) {
    Box centres;
    for (uint32_t i = begin; i < end; ++i) centres.grow(centre(order_[i]));
    const glm::vec3 extent = centres.hi - centres.lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const float scale = kBins / extent[axis];
    const auto first = order_.begin() + begin, last = order_.begin() + end;
    if (depth < kMaxHeuristicDepth && extent[axis] > 0 && std::isfinite(scale)) {
      const auto bin = [&](uint32_t t) {
        return std::min(uint32_t((centre(t)[axis] - centres.lo[axis]) * scale), kBins - 1);
      };
      const uint32_t best = bestPlane(begin, end, bin);
      const auto middle = std::partition(first, last, [&](uint32_t t) { return bin(t) < best; });
      if (middle != first && middle != last) return uint32_t(middle - order_.begin());
    }
    const auto middle = first + (end - begin) / 2;
    std::nth_element(first, middle, last,
                     [&](uint32_t a, uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
    return uint32_t(middle - order_.begin());
  }

  // The plane before bin b, 0 < b < kBins, with the least sum of area times count over both sides.
  template <class Bin>
  uint32_t bestPlane(uint32_t begin, uint32_t end, const Bin& bin) const {
    std::array<Box, kBins> boxes;
    std::array<uint32_t, kBins> counts{};
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t b = bin(order_[i]);
      boxes[b].grow(boxes_[order_[i]]);
      ++counts[b];
    }
    std::array<float, kBins> cost{};  // of the bins from b on
    Box right, left;
    uint32_t rightCount = 0, leftCount = 0, best = kBins / 2;
    for (uint32_t b = kBins - 1; b > 0; --b) {
      right.grow(boxes[b]);
      rightCount += counts[b];
      cost[b] = rightCount ? right.area() * float(rightCount) : 0;
    }
    float least = std::numeric_limits<float>::infinity();
    for (uint32_t b = 1; b < kBins; ++b) {
      left.grow(boxes[b - 1]);
      leftCount += counts[b - 1];
      const float total = cost[b] + (leftCount ? left.area() * float(leftCount) : 0);
      if (leftCount == 0 || leftCount == end - begin || total >= least) continue;
      least = total;
      best = b;
    }
    return best;
  }

  uint32_t first_ = 0;           // of the range
  std::vector<Box> boxes_;       // of its triangles
  std::vector<uint32_t> order_;  // indices of the range
};

}  // namespace

Bvh buildBvh(const Geometry& geometry, TriangleRange range) { return Builder(geometry, range).build(); }

RefitOrder refitOrder(const Bvh& bvh, uint32_t nodesPerPart) {
  RefitOrder order{{}, {0}, {0}};
  const auto count = uint32_t(bvh.nodes.size());
  std::vector<uint32_t> size(count, 1);  // nodes of each subtree that are in no part yet
  const auto isLeaf = [&](uint32_t node) { return bvh.nodes[node].count > 0 || bvh.order.empty(); };
  const auto addPart = [&](uint32_t root) {
    std::vector<uint32_t> stack{root};
    const auto begin = std::ptrdiff_t(order.nodes.size());
    while (!stack.empty()) {
      const uint32_t node = stack.back();
      stack.pop_back();
      if (size[node] == 0) continue;
      order.nodes.push_back(node);
      if (!isLeaf(node)) stack.insert(stack.end(), {bvh.nodes[node].first, bvh.nodes[node].first + 1});
    }
    std::reverse(order.nodes.begin() + begin, order.nodes.end());
    order.parts.push_back(uint32_t(order.nodes.size()));
  };
  while (order.nodes.size() < count) {
    for (uint32_t node = count; node-- > 0;)  // children before their parents
      if (size[node] > 0 && !isLeaf(node))
        size[node] = 1 + size[bvh.nodes[node].first] + size[bvh.nodes[node].first + 1];
    std::vector<uint32_t> stack{0};
    const auto begin = std::ptrdiff_t(order.nodes.size());
    while (!stack.empty()) {
      const uint32_t node = stack.back();
      stack.pop_back();
      if (size[node] == 0) continue;
      if (size[node] <= nodesPerPart)
        addPart(node);
      else
        stack.insert(stack.end(), {bvh.nodes[node].first, bvh.nodes[node].first + 1});
    }
    for (const uint32_t node : std::span(order.nodes).subspan(size_t(begin))) size[node] = 0;
    order.rounds.push_back(uint32_t(order.parts.size() - 1));
  }
  return order;
}

BvhTables::BvhTables() : nodes(kBvhTops) { nodes[0].first = kBvhStill; }

uint32_t BvhTables::add(const Bvh& bvh, uint32_t top, const Geometry& geometry,
                        const std::function<bool(uint32_t)>& hasHoles) {
  const uint32_t base = uint32_t(nodes.size()) - 1, firstTriangle = uint32_t(triangles.size());
  const auto placed = [&](BvhNode node) {
    node.first += node.count > 0 ? firstTriangle : base;
    return node;
  };
  nodes[top] = bvh.order.empty() ? bvh.nodes[0] : placed(bvh.nodes[0]);
  for (size_t i = 1; i < bvh.nodes.size(); ++i) nodes.push_back(placed(bvh.nodes[i]));
  for (const uint32_t t : bvh.order) {
    const Triangle& triangle = geometry.triangles[t];
    triangles.emplace_back(triangle.v[0], triangle.v[1], triangle.v[2], hasHoles(t) ? t | kRayHoles : t);
  }
  return base;
}

}  // namespace fovea::scene
