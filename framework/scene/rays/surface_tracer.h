// Traces single rays through the triangles and evaluates the light at what they hit, for passes that trace few rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "framework/scene/frame.h"
#include "framework/scene/materials/surface_materials.h"
#include "framework/scene/rays/emitters.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/rays/reflection.h"

namespace fovea::scene {

// A surface as seen by the ray that reached it.
struct TracedSurface {
  bool there = false;            // false on a black back, too
  uint32_t triangle = kNoIndex;  // index into Geometry::triangles; kNoIndex if the ray has met nothing
  float u = 0, v = 0;            // barycentric weights of the triangle's second and third vertex
  glm::vec3 position{0};         // world space, m
  glm::vec3 origin{0};           // start of rays that leave it, just off the surface
  glm::vec3 normal{0}, face{0};  // shading and geometric, unit, on the side reached
  glm::vec2 uv{0};
  const Material* material = nullptr;
  // The factor on its light that makes up for the rays that glass has let through, and what glass before it makes of
  // the light on its way along the ray; the latter alone if the ray met nothing.
  glm::vec3 brighter{1};

  bool isOutside() const { return triangle == kNoIndex; }
};

// Point `turn` of the R2 sequence (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018), whose
// starting point is drawn from `stream`.
glm::vec2 streamSequence(uint32_t stream, uint32_t turn);
glm::vec3 cosineDirection(glm::vec3 normal, glm::vec2 u);

// Follows the conventions of the path tracers: the eye looks through the back of a single-sided material, whereas for
// light the back is black. `rays` counts the rays traced.
class SurfaceTracer {
 public:
  // fullMaterials: reflection() is that of full materials, and reflectance() as in materials/bounced.h.
  SurfaceTracer(const Frame& frame, const View& view, const RayScene& rays, bool fullMaterials = false);

  // The surface that the eye sees at `pixel` (pixels, centres at +0.5). Where surfaces let a part of the light through,
  // it is the one that pass gbuffer shows in this frame.
  TracedSurface look(glm::vec2 pixel, uint64_t& rays) const;
  // The surface met within `reach` metres. direction: unit. Where surfaces let a part of the light through, the ray
  // passes with the probability of the light that does.
  TracedSurface arrive(glm::vec3 origin, glm::vec3 direction, float reach, uint64_t& rays) const;
  // Radiance from v in the direction `out` (unit), from where it is seen: emitted, or light of the scene's lights after
  // one reflection. leastRoughness: as in reflection().
  glm::vec3 seen(const TracedSurface& v, glm::vec3 out, uint64_t& rays, float leastRoughness = 0) const;
  // How v reflects light in the direction `out`, unit. rho: its reflectance, with diffuse materials. With full ones it
  // is treated as at least as rough as leastRoughness, the roughness of a surface that passes the light on and blurs
  // it: then a few rays find a wide, dim highlight rather than a small, bright one (Kaplanyan and Dachsbacher, "Path
  // Space Regularization for Holistic and Robust Light Transport", 2013).
  Reflection reflection(const TracedSurface& v, glm::vec3 out, glm::vec3 rho, float leastRoughness) const;
  glm::vec3 reflectance(const TracedSurface& v) const;
  glm::vec3 emitted(const TracedSurface& v) const;  // radiance, W/(sr m^2)
  // Radiance that leaves v after one reflection of light from the scene's lights.
  glm::vec3 direct(const TracedSurface& v, const Reflection& reflection, uint64_t& rays) const;
  // The same in the direction `out`; the parameters are those of reflection().
  glm::vec3 directTowards(const TracedSurface& v, glm::vec3 out, glm::vec3 rho, float leastRoughness,
                          uint64_t& rays) const;
  // Cosine-weighted mean radiance that reaches v over its hemisphere from emissive surfaces, and that of all light
  // after at most `bounces` reflections, estimated with `count` rays, each of which continues with one ray per further
  // bounce, and with one point on an emissive surface at each vertex. Surfaces send the light of lamps to where the ray
  // came from as reflection() says, and other light diffusely.
  glm::vec3 gather(const TracedSurface& v, uint32_t bounces, uint32_t count, uint32_t stream,
                   uint64_t& rays) const;
  // Radiance that v sends in the direction of `reflection` of the light that reaches it as in gather(). With a full one
  // the rays are chosen by it.
  glm::vec3 passedOn(const TracedSurface& v, const Reflection& reflection, uint32_t bounces, uint32_t count,
                     uint32_t stream, uint64_t& rays) const;

  // The ray from v to a point on an emissive surface, or to the scene's environment map.
  struct EmitterRay {
    bool there = false;      // whether a point was found that faces v and may light it; it may be hidden
    glm::vec3 direction{0};  // unit
    float distance = 0;      // m; kFarAway to the environment
    float density = 0;       // probability density of the direction, per sr
    uint32_t triangle = kNoIndex;  // kNoIndex in the environment
    glm::vec3 radiance{0};         // W/(sr m^2)
  };
  bool hasEmitters() const { return !emitters_.empty() || environment_ != nullptr; }
  bool hasEnvironment() const { return environment_ != nullptr; }
  const Emitters& emitters() const { return emitters_; }
  EmitterRay towardsEmitter(const TracedSurface& v, uint32_t stream) const;
  // u: uniform in [0, 1); x chooses the emitter.
  EmitterRay towardsEmitter(const TracedSurface& v, glm::vec3 u) const;
  // The ray to the environment in a given direction, which is unit.
  EmitterRay towardsOutside(const TracedSurface& v, glm::vec3 direction) const;
  // The share of its light that reaches v.
  glm::vec3 visibility(const TracedSurface& v, const EmitterRay& to, uint64_t& rays) const;
  // Density with which towardsEmitter() chooses the direction from v to the surface `hit`, per sr; 0 if `hit` does not
  // emit.
  float emitterDensity(const TracedSurface& v, const TracedSurface& hit) const;
  // The light of the environment map that a ray from v carries if it hits nothing: its radiance, and the density with
  // which towardsEmitter() chooses the direction, per sr. Zeros without a map.
  struct Outside {
    glm::vec3 radiance{0};
    float density = 0;
  };
  Outside outside(glm::vec3 direction) const;

 private:
  TracedSurface surfaceOf(const RayHit& hit, glm::vec3 direction) const;
  // Follows a ray to the surface that stops it. meetsBacks: whether it is stopped by the backs of single-sided
  // materials, which are black. chanceAt(triangle): uniform in [0, 1).
  template <class Function>
  TracedSurface follow(Ray ray, bool meetsBacks, const Function& chanceAt, uint64_t& rays) const;
  // Whether a ray passes a surface that it meets. direction: unit; chance: uniform in [0, 1).
  bool passes(const TracedSurface& v, glm::vec3 direction, float chance) const;
  // Different for every ray and frame; 0 where nothing is left to chance.
  uint32_t keyOf(glm::vec3 origin, glm::vec3 direction) const;
  // The sum over the lights that reach v of what `respond` makes of their irradiance and direction.
  template <class Function>
  glm::vec3 fromLights(const TracedSurface& v, uint64_t& rays, const Function& respond) const;
  glm::vec3 irradiance(const TracedSurface& v, uint64_t& rays) const;
  // Adds what a ray from v brings, times `factor`, to a sum. density: that of the direction, times the number of rays
  // from v, per sr. The other parameters are those of gather().
  void addArriving(glm::vec3& sum, glm::vec3 factor, const TracedSurface& v, glm::vec3 direction,
                   float density, uint32_t bounces, uint32_t stream, uint64_t& rays) const;
  glm::vec3 fromEmitters(const TracedSurface& v, uint32_t count, uint32_t stream, uint64_t& rays) const;

  const Frame& frame_;
  const View& view_;
  const RayScene& rays_;
  Emitters emitters_;
  const EnvironmentMap* environment_;
  float surfaceShare_;  // probability with which towardsEmitter() chooses a surface, not the environment
  std::optional<SurfaceMaterials> materials_;  // if they are full
};

}  // namespace fovea::scene
