// A bounding volume hierarchy built by the binned surface area heuristic (Wald 2007), with the watertight
// ray/triangle test of Woop, Benthin and Wald (JCGT 2013). About ten times slower than Embree.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "framework/scene/rays/ray_tracer.h"

namespace fovea::scene {
namespace {

constexpr uint32_t kBins = 16, kLeafSize = 4;
constexpr uint32_t kMaxHeuristicDepth =
    40;  // then halves: 40 + log2(2^26 triangles) bounds the traversal stack
constexpr uint32_t kStackSize = 72;

struct Box {
  glm::vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};
  void grow(glm::vec3 p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void grow(const Box& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
  float area() const {
    const glm::vec3 d = glm::max(hi - lo, glm::vec3(0));
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

struct Node {
  Box box;
  uint32_t first = 0;  // leaf: its first entry in the order; inner node: the first of its two children
  uint32_t count = 0;  // number of triangles; 0 for an inner node
};

class Builder {
 public:
  explicit Builder(const std::vector<std::array<glm::vec3, 3>>& triangles) : order(triangles.size()) {
    std::iota(order.begin(), order.end(), 0u);
    for (const auto& t : triangles) {
      Box& b = boxes_.emplace_back();
      for (const glm::vec3& p : t) b.grow(p);
    }
    nodes.emplace_back();
    if (!triangles.empty()) build(0, 0, uint32_t(triangles.size()), 0);
  }
  std::vector<Node> nodes;
  std::vector<uint32_t> order;  // triangles in leaf order

 private:
  glm::vec3 centre(uint32_t t) const { return 0.5f * (boxes_[t].lo + boxes_[t].hi); }

  // nodes[index] takes order[begin, end).
  void build(uint32_t index, uint32_t begin, uint32_t end, uint32_t depth) {
    Box box, centres;
    for (uint32_t i = begin; i < end; ++i) box.grow(boxes_[order[i]]), centres.grow(centre(order[i]));
    nodes[index] = {box, begin, end - begin};
    if (end - begin <= kLeafSize) return;
    const uint32_t middle = split(begin, end, centres, depth);
    const uint32_t children = uint32_t(nodes.size());
    nodes.resize(nodes.size() + 2);
    nodes[index].first = children;
    nodes[index].count = 0;
    build(children, begin, middle, depth + 1);
    build(children + 1, middle, end, depth + 1);
  }

  // Partitions [begin, end) into two parts and returns the start of the second.
  uint32_t split(uint32_t begin, uint32_t end, const Box& centres, uint32_t depth) {
    const glm::vec3 extent = centres.hi - centres.lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const float scale = kBins / extent[axis];
    const auto first = order.begin() + begin, last = order.begin() + end;
    if (depth < kMaxHeuristicDepth && extent[axis] > 0 && std::isfinite(scale)) {
      const auto bin = [&](uint32_t t) {
        return std::min(uint32_t((centre(t)[axis] - centres.lo[axis]) * scale), kBins - 1);
      };
      const uint32_t best = bestPlane(begin, end, bin);
      const auto middle = std::partition(first, last, [&](uint32_t t) { return bin(t) < best; });
      if (middle != first && middle != last) return uint32_t(middle - order.begin());
    }
    const auto middle = first + (end - begin) / 2;
    std::nth_element(first, middle, last,
                     [&](uint32_t a, uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
    return uint32_t(middle - order.begin());
  }

  // The plane before bin b, 0 < b < kBins, with the least sum of area times count over both sides.
  template <class Bin>
  uint32_t bestPlane(uint32_t begin, uint32_t end, const Bin& bin) const {
    std::array<Box, kBins> boxes;
    std::array<uint32_t, kBins> counts{};
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t b = bin(order[i]);
      boxes[b].grow(boxes_[order[i]]);
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

  std::vector<Box> boxes_;
};

// A ray prepared for both tests.
struct PreparedRay {
  glm::vec3 origin, inverse;
  float near, far;
  int kx, ky, kz;    // kz: the axis along which the ray is longest
  float sx, sy, sz;  // shear that maps the direction to +z
  explicit PreparedRay(const Ray& r)
      : origin(r.origin), inverse(1.0f / r.direction), near(r.near), far(r.far) {
    const glm::vec3 a = glm::abs(r.direction);
    kz = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    if (r.direction[kz] < 0) std::swap(kx, ky);
    sx = r.direction[kx] / r.direction[kz];
    sy = r.direction[ky] / r.direction[kz];
    sz = 1.0f / r.direction[kz];
  }

  // Entry distance, or infinity. Comparisons are written so that NaN (a ray within a face of the box) counts
  // as inside; the far side is widened by the rounding error of the products (Ize, JCGT 2013).
  float enter(const Box& box) const {
    float t0 = near, t1 = far;
    for (int k = 0; k < 3; ++k) {
      float a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
      if (a > b) std::swap(a, b);
      b *= 1 + 4 * std::numeric_limits<float>::epsilon();
      if (a > t0) t0 = a;
      if (b < t1) t1 = b;
      if (t0 > t1) return std::numeric_limits<float>::infinity();
    }
    return t0;
  }
};

// Hit within (near, far), or a hit without a triangle.
RayHit hitTriangle(const PreparedRay& r, const std::array<glm::vec3, 3>& triangle) {
  const glm::vec3 a = triangle[0] - r.origin, b = triangle[1] - r.origin, c = triangle[2] - r.origin;
  const float ax = a[r.kx] - r.sx * a[r.kz], ay = a[r.ky] - r.sy * a[r.kz];
  const float bx = b[r.kx] - r.sx * b[r.kz], by = b[r.ky] - r.sy * b[r.kz];
  const float cx = c[r.kx] - r.sx * c[r.kz], cy = c[r.ky] - r.sy * c[r.kz];
  float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if (u == 0 || v == 0 ||
      w == 0) {  // on an edge in single precision: decide in double, the same for both neighbours
    u = float(double(cx) * by - double(cy) * bx);
    v = float(double(ax) * cy - double(ay) * cx);
    w = float(double(bx) * ay - double(by) * ax);
  }
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
  const float det = u + v + w;
  if (!(det != 0)) return {};
  const float t = r.sz * (u * a[r.kz] + v * b[r.kz] + w * c[r.kz]) / det;
  if (!(t > r.near && t < r.far)) return {};
  return {0, t, v / det, w / det};
}

class BvhTracer : public RayTracer {
 public:
  BvhTracer(const Geometry& geometry, Accepts accepts, TriangleRange range) : accepts_(std::move(accepts)) {
    std::vector<std::array<glm::vec3, 3>> triangles;
    const uint32_t end = std::min(range.end, uint32_t(geometry.triangles.size()));
    triangles.reserve(end - range.first);
    for (uint32_t i = range.first; i < end; ++i) {
      const Triangle& t = geometry.triangles[i];
      triangles.push_back(
          {geometry.positions[t.v[0]], geometry.positions[t.v[1]], geometry.positions[t.v[2]]});
    }
    Builder builder(triangles);
    nodes_ = std::move(builder.nodes);
    order_ = std::move(builder.order);
    triangles_.reserve(order_.size());
    for (uint32_t& t : order_) {
      triangles_.push_back(triangles[t]);
      t += range.first;
    }
  }

  RayHit intersect(const Ray& ray) const override { return trace(ray, false); }
  bool occluded(const Ray& ray) const override { return bool(trace(ray, true)); }

 private:
  RayHit trace(const Ray& ray, bool any) const {
    RayHit best;
    if (triangles_.empty()) return best;
    PreparedRay r(ray);
    constexpr float kMiss = std::numeric_limits<float>::infinity();
    std::array<std::pair<uint32_t, float>, kStackSize> stack;  // node, entry distance
    uint32_t size = 0;
    if (const float t = r.enter(nodes_[0].box); t < kMiss) stack[size++] = {0, t};
    while (size > 0) {
      const auto [index, entry] = stack[--size];
      if (entry > r.far) continue;
      const Node& node = nodes_[index];
      if (node.count > 0) {
        if (hitLeaf(node, r, best) && any) return best;
        continue;
      }
      std::pair<uint32_t, float> a{node.first, r.enter(nodes_[node.first].box)};
      std::pair<uint32_t, float> b{node.first + 1, r.enter(nodes_[node.first + 1].box)};
      if (a.second < b.second) std::swap(a, b);  // the nearer child is visited first
      if (a.second < kMiss) stack[size++] = a;
      if (b.second < kMiss) stack[size++] = b;
    }
    return best;
  }

  // Shortens the ray to every hit that is accepted.
  bool hitLeaf(const Node& node, PreparedRay& r, RayHit& best) const {
    bool found = false;
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      RayHit hit = hitTriangle(r, triangles_[i]);
      if (!hit) continue;
      hit.triangle = order_[i];
      if (accepts_ && !accepts_(hit.triangle, hit.u, hit.v)) continue;
      best = hit;
      r.far = hit.distance;
      found = true;
    }
    return found;
  }

  Accepts accepts_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;
  std::vector<std::array<glm::vec3, 3>> triangles_;  // in leaf order
};

}  // namespace

std::unique_ptr<RayTracer> makeBvhTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                         TriangleRange range) {
  return std::make_unique<BvhTracer>(geometry, std::move(accepts), range);
}

}  // namespace fovea::scene
