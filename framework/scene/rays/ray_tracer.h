// The acceleration structures behind RayScene: Embree, if it is built in, and a small one of the project for bundles
// that have no room for Embree's 44 MB.
#pragma once

#include <functional>
#include <memory>

#include "framework/scene/rays/bvh.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {

// Both look-ups may be called from many threads at once. Triangles are hit from both sides, and no ray slips through
// a shared edge.
class RayTracer {
 public:
  // Whether triangle `t` is present at the barycentric weights u, v of its second and third vertex. If empty,
  // it always is.
  using Accepts = std::function<bool(uint32_t t, float u, float v)>;
  virtual ~RayTracer() = default;
  virtual RayHit intersect(const Ray& ray) const = 0;
  virtual bool occluded(const Ray& ray) const = 0;
};

// Positions and indices are copied. Both throw Error(OutOfMemory).
std::unique_ptr<RayTracer> makeEmbreeTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                            TriangleRange range = {});
std::unique_ptr<RayTracer> makeBvhTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                         TriangleRange range = {});

}  // namespace fovea::scene
