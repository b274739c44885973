// Traces rays on the CPU against the world-space triangles of one moment and respects holes in materials. Uses Embree 3
// or, in portable bundles, a small tracer of the project.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct Ray {
  glm::vec3 origin{0};     // world space, m
  glm::vec3 direction{0};  // need not be unit; distances are multiples of its length
  float near = 0, far = std::numeric_limits<float>::infinity();
};

// What rays do at surfaces that let a part of the light through, with alphaMode BLEND or thin glass. Holes of alpha
// masks are open in any case.
enum class Passing : uint8_t {
  Never,  // diffuse materials: BLEND is a mask, and glass is solid
  Met,    // such surfaces are met everywhere: who traces decides
};

struct RayHit {
  uint32_t triangle = kNoIndex;  // index into Geometry::triangles
  float distance = 0;            // in multiples of the length of the ray's direction
  float u = 0, v = 0;            // barycentric weights of the triangle's second and third vertex
  explicit operator bool() const { return triangle != kNoIndex; }
};

// A surface at a hit. Normals are as in the model: they are not turned towards the ray.
struct SurfaceHit {
  glm::vec3 position{0};         // world space, m
  glm::vec3 geometricNormal{0};  // unit, on the side seen counter-clockwise
  glm::vec3 shadingNormal{0};    // unit, interpolated; within 90 degrees of the geometric one
  glm::vec2 uv{0};
  uint32_t material = 0, object = 0;
};

// Immutable after construction, so many threads may trace at once. Copies what it needs of materials with holes:
// neither scene nor geometry has to outlive it.
class RayScene {
 public:
  RayScene(const Scene& scene, const Geometry& geometry, Passing passing = Passing::Never);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  RayHit intersect(const Ray& ray) const;  // nearest hit in (near, far)
  bool occluded(const Ray& ray) const;

  // Whether rays meet the surface at this point of its triangle, which they do not in the holes of alpha masks.
  bool isSolid(const RayHit& point) const;
  // Whether rays may meet surfaces that let a part of the light through.
  bool meetsTransparency() const;
  // Smallest distance that keeps a ray that leaves a surface from hitting it again: 1e-5 of the scene's diagonal.
  float epsilon() const;
  double surfaceArea() const;  // of all triangles, one side, m^2

  // The acceleration structure of `geometry`, rebuilt if its content (or the holes of `scene`) differs from the
  // last requests; the two most recent structures are kept. If only dynamic objects have moved, only their part
  // is rebuilt. Reads all of the geometry only if Geometry::stillKey is not known. Thread-safe.
  static std::shared_ptr<const RayScene> cached(const Scene& scene, const Geometry& geometry,
                                                Passing passing = Passing::Never);

 private:
  struct Still;
  struct Impl;
  RayScene(std::shared_ptr<const Still> still, const Geometry& geometry);
  std::unique_ptr<Impl> impl_;
};

// Geometry::stillKey of `geometry`, never 0.
uint64_t stillKey(const Scene& scene, const Geometry& geometry);

// Attributes at a hit. `geometry` must be the one in which the ray was traced.
SurfaceHit surfaceAt(const Geometry& geometry, const RayHit& hit);

// Everything surfaceAt() needs from one triangle, side by side: two cache lines instead of ten, for callers that look
// up millions of hits.
struct alignas(64) TriangleVertices {
  glm::vec3 positions[3], normals[3];  // normals have length 0 if the geometry has none
  glm::vec2 uvs[3];
  uint32_t materialAndObject;
};
TriangleVertices triangleVertices(const Geometry& geometry, uint32_t triangle);
SurfaceHit surfaceAt(const TriangleVertices& triangle, float u, float v);

}  // namespace fovea::scene
