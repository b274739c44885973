// Traces single rays through the triangles and evaluates the diffuse light at what they hit, for passes that
// trace few rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::scene {

// A surface as seen by the ray that reached it.
struct TracedSurface {
  bool there = false;
  glm::vec3 position{0};         // world space, m
  glm::vec3 origin{0};           // start of rays that leave it, just off the surface
  glm::vec3 normal{0}, face{0};  // shading and geometric, unit, on the side reached
  glm::vec2 uv{0};
  const Material* material = nullptr;
};

// Point `turn` of the R2 sequence (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018), whose
// starting point is drawn from `stream`.
glm::vec2 streamSequence(uint32_t stream, uint32_t turn);
glm::vec3 cosineDirection(glm::vec3 normal, glm::vec2 u);

// Follows the conventions of the path tracers: the eye looks through the back of a single-sided material, whereas for
// light the back is black. `rays` counts the rays traced.
class SurfaceTracer {
 public:
  SurfaceTracer(const Frame& frame, const View& view, const RayScene& rays);

  // The surface that the eye sees at `pixel` (pixels, centres at +0.5).
  TracedSurface look(glm::vec2 pixel, uint64_t& rays) const;
  // The surface met within `reach` metres. direction: unit.
  TracedSurface arrive(glm::vec3 origin, glm::vec3 direction, float reach, uint64_t& rays) const;
  glm::vec3 reflectance(const TracedSurface& v) const;
  // Radiance that leaves v, whose reflectance is rho, after one reflection of light from the scene's lights, plus the
  // emission of v.
  glm::vec3 direct(const TracedSurface& v, glm::vec3 rho, uint64_t& rays) const;
  // Cosine-weighted mean radiance that reaches v over its hemisphere after at most `bounces` reflections, estimated
  // with `count` rays, each of which continues with one ray per further bounce.
  glm::vec3 gather(const TracedSurface& v, uint32_t bounces, uint32_t count, uint32_t stream,
                   uint64_t& rays) const;

 private:
  TracedSurface surfaceOf(const RayHit& hit, glm::vec3 direction) const;
  glm::vec3 irradiance(const TracedSurface& v, uint64_t& rays) const;

  const Frame& frame_;
  const View& view_;
  const RayScene& rays_;
  bool shines_ = false;  // whether any material emits
};

}  // namespace fovea::scene
