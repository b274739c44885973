// Traces rays on the host with the tracer of the shaders, about ten times slower than Embree.
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/rays/bvh.h"
#include "framework/scene/rays/ray_tracer.h"

#include "shaders/device/language.h"

namespace fovea::scene {
namespace {

using namespace glm;

// What the shader finds here of a scene.
struct Walk {
  struct RayHit {
    uint triangle;
    float distance;
    vec2 weights;
  };
  static constexpr uint kNoTriangle = kNoIndex;

  const uvec4 *rayNodes, *rayTriangles;
  const vec3* positions;
  const RayTracer::Accepts& accepts;

  const vec3& scenePosition(uint vertex) const { return positions[vertex]; }
  bool solidAt(uint triangle, uvec4, vec2 weights) const { return accepts(triangle, weights.x, weights.y); }

#include "shaders/rays/bvh.glsl"
};

class BvhTracer : public RayTracer {
 public:
  BvhTracer(const Geometry& geometry, Accepts accepts, TriangleRange range)
      : accepts_(std::move(accepts)), positions_(geometry.positions) {
    BvhTables tables;
    tables.add(buildBvh(geometry, range), kBvhStill, geometry, [this](uint32_t) { return bool(accepts_); });
    triangles_ = std::move(tables.triangles);
    nodes_.resize(2 * tables.nodes.size());
    std::memcpy(nodes_.data(), tables.nodes.data(), nodes_.size() * sizeof(uvec4));
  }

  RayHit intersect(const Ray& ray) const override { return trace(ray, false); }
  bool occluded(const Ray& ray) const override { return bool(trace(ray, true)); }

 private:
  RayHit trace(const Ray& ray, bool any) const {
    Walk walk{nodes_.data(), triangles_.data(), positions_.data(), accepts_};
    const Walk::RayHit hit = walk.trace(ray, any);
    if (hit.triangle == Walk::kNoTriangle) return {};
    return {hit.triangle, hit.distance, hit.weights.x, hit.weights.y};
  }

  Accepts accepts_;
  std::vector<vec3> positions_;
  std::vector<uvec4> nodes_, triangles_;
};

}  // namespace

std::unique_ptr<RayTracer> makeBvhTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                         TriangleRange range) {
  return std::make_unique<BvhTracer>(geometry, std::move(accepts), range);
}

}  // namespace fovea::scene
