// Traces rays through the project's own bounding volume hierarchy, with the watertight ray/triangle test of Woop, Benthin
// and Wald (JCGT 2013), as shaders/rays/trace.glsl does on the device. About ten times slower than Embree.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "framework/scene/rays/bvh.h"
#include "framework/scene/rays/ray_tracer.h"

namespace fovea::scene {
namespace {

// A ray prepared for both tests.
struct PreparedRay {
  glm::vec3 origin, inverse;
  float near, far;
  int kx, ky, kz;    // kz: the axis along which the ray is longest
  float sx, sy, sz;  // shear that maps the direction to +z
  explicit PreparedRay(const Ray& r) : origin(r.origin), near(r.near), far(r.far) {
    // No component is 0, so that a ray within a face of a box is inside.
    for (int k = 0; k < 3; ++k)
      inverse[k] = 1.0f / (std::abs(r.direction[k]) > kLeastDirection
                               ? r.direction[k]
                               : std::copysign(kLeastDirection, r.direction[k]));
    const glm::vec3 a = glm::abs(r.direction);
    kz = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    if (r.direction[kz] < 0) std::swap(kx, ky);
    sx = r.direction[kx] / r.direction[kz];
    sy = r.direction[ky] / r.direction[kz];
    sz = 1.0f / r.direction[kz];
  }

  // Entry distance, or infinity. The far side is widened by the rounding error of the products (Ize, JCGT 2013).
  float enter(const BvhNode& node) const {
    float t0 = near, t1 = far;
    for (int k = 0; k < 3; ++k) {
      float a = (node.low[k] - origin[k]) * inverse[k], b = (node.high[k] - origin[k]) * inverse[k];
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
  BvhTracer(const Geometry& geometry, Accepts accepts, TriangleRange range)
      : accepts_(std::move(accepts)), bvh_(buildBvh(geometry, range)) {
    triangles_.reserve(bvh_.order.size());
    for (const uint32_t index : bvh_.order) {
      const Triangle& t = geometry.triangles[index];
      triangles_.push_back(
          {geometry.positions[t.v[0]], geometry.positions[t.v[1]], geometry.positions[t.v[2]]});
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
    std::array<std::pair<uint32_t, float>, kBvhDepth> stack;  // node, entry distance
    uint32_t size = 0;
    if (const float t = r.enter(bvh_.nodes[0]); t < kMiss) stack[size++] = {0, t};
    while (size > 0) {
      const auto [index, entry] = stack[--size];
      if (entry > r.far) continue;
      const BvhNode& node = bvh_.nodes[index];
      if (node.count > 0) {
        if (hitLeaf(node, r, best) && any) return best;
        continue;
      }
      std::pair<uint32_t, float> a{node.first, r.enter(bvh_.nodes[node.first])};
      std::pair<uint32_t, float> b{node.first + 1, r.enter(bvh_.nodes[node.first + 1])};
      if (a.second < b.second) std::swap(a, b);  // the nearer child is visited first
      if (a.second < kMiss) stack[size++] = a;
      if (b.second < kMiss) stack[size++] = b;
    }
    return best;
  }

  // Shortens the ray to every hit that is accepted.
  bool hitLeaf(const BvhNode& node, PreparedRay& r, RayHit& best) const {
    bool found = false;
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      RayHit hit = hitTriangle(r, triangles_[i]);
      if (!hit) continue;
      hit.triangle = bvh_.order[i];
      if (accepts_ && !accepts_(hit.triangle, hit.u, hit.v)) continue;
      best = hit;
      r.far = hit.distance;
      found = true;
    }
    return found;
  }

  Accepts accepts_;
  Bvh bvh_;
  std::vector<std::array<glm::vec3, 3>> triangles_;  // in leaf order
};

}  // namespace

std::unique_ptr<RayTracer> makeBvhTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                         TriangleRange range) {
  return std::make_unique<BvhTracer>(geometry, std::move(accepts), range);
}

}  // namespace fovea::scene
