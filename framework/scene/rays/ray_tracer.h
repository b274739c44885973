// The acceleration structures behind RayScene: Embree, if it is built in, and a small one of the project for bundles
// that have no room for Embree's 44 MB.
#pragma once

#include <functional>
#include <memory>

#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {

// Both look-ups may be called from many threads at once. Triangles are hit from both sides, and no ray slips through
// a shared edge.
class RayTracer {
 public:
  struct Meeting {
    uint32_t triangle = kNoIndex;
    float u = 0, v = 0;  // barycentric weights of its second and third vertex
    float cosine = 1;    // between the ray and its geometric normal, positive
    uint32_t key = 0;    // of the ray
  };
  // Whether a triangle stops a ray. If empty, it always does.
  using Accepts = std::function<bool(const Meeting& at)>;
  virtual ~RayTracer() = default;
  virtual RayHit intersect(const Ray& ray) const = 0;
  virtual bool occluded(const Ray& ray) const = 0;
};

// Triangles [first, end) of a geometry.
struct TriangleRange {
  uint32_t first = 0, end = ~0u;
};

// Positions and indices are copied. Both throw Error(OutOfMemory).
std::unique_ptr<RayTracer> makeEmbreeTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                            TriangleRange range = {});
std::unique_ptr<RayTracer> makeBvhTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                         TriangleRange range = {});

}  // namespace fovea::scene
