// Light along single paths between surfaces with full materials (passes/path-trace/bsdf.h).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/path-trace/bsdf.h"
#include "passes/path-trace/emitters.h"
#include "passes/path-trace/environment.h"
#include "passes/path-trace/materials.h"
#include "passes/path-trace/path_integrator.h"

namespace fovea::path_trace {

// The same rules as those of PathIntegrator, and these:
//
// - Directions are chosen by the BSDF, and light from emissive triangles and the environment map by the balance
//   heuristic between that and points on them.
// - Light goes straight through thin glass, and through a surface with alphaMode BLEND where that does not cover what
//   is behind it. Neither is an edge of a path. Glass has the same faces on both sides for light, but the eye looks
//   through the back of a single-sided one.
// - What is unlit is only seen by the eye, directly or through glass.
class FullIntegrator {
 public:
  FullIntegrator(const scene::Frame& frame, const scene::View& view, const scene::RayScene& rays,
                 uint32_t depth);

  struct Vertex {
    glm::vec3 position{0};  // world space, m
    glm::vec3 origin{0};    // of rays that leave it, just off the surface
    glm::vec3 face{0};      // geometric normal, unit, on the viewer's side
    glm::mat3 frame{1};     // local to world
    Bsdf bsdf;
  };
  // A surface that the eye sees, through those before it in the list.
  struct Seen {
    Vertex vertex;
    glm::vec3 weight{1};    // share of its light that reaches the eye
    float probability = 1;  // that a path begins here
  };
  struct EyePoint {
    bool surface = false;
    std::vector<Seen> vertex;
    glm::vec3 direct{0};
  };
  EyePoint look(glm::vec2 pixel, uint64_t& rays) const;
  void indirect(const std::vector<Seen>& first, std::span<const PathSampler> random,
                std::span<glm::vec3> light, uint64_t& rays) const;

 private:
  struct Path {
    Vertex vertex;
    glm::vec3 throughput{1}, light{0};
  };
  scene::RayHit intersect(const scene::Ray& ray, uint64_t& rays) const;
  static scene::Ray beyond(scene::Ray ray, const scene::RayHit& hit);
  // direction: unit, of the ray that arrives.
  Vertex vertexAt(const SurfacePoint& point, glm::vec3 direction) const;
  // The BSDF times the cosine, per sr.
  static glm::vec3 reflected(const Vertex& v, glm::vec3 direction);
  // The share of light that passes the surface, in the same way in both directions.
  static glm::vec3 passing(const SurfacePoint& s, const Vertex& v) {
    return glm::vec3(1 - s.coverage) + s.coverage * v.bsdf.transmittance();
  }
  // The share of light that passes along the ray.
  glm::vec3 visibility(scene::Ray ray, uint64_t& rays) const;
  // Radiance from one light that v reflects, ignoring occlusion.
  glm::vec3 unshadowed(const scene::Light& light, const Vertex& v, scene::Ray& shadowRay) const;
  glm::vec3 allLights(const Vertex& v, uint64_t& rays) const;
  // The same on average, using random number k where there is a choice.
  glm::vec3 oneLight(const Vertex& v, const PathSampler& random, uint32_t k, uint64_t& rays) const;
  glm::vec3 environmentLight(const Vertex& v, float u1, float u2, uint64_t& rays) const;
  glm::vec3 emitterLight(const Vertex& v, float choice, float u1, float u2, uint64_t& rays) const;
  void trace(Path& path, const PathSampler& random, uint64_t& rays) const;
  // Goes on to the next surface; false if the path ends. `edges` join the vertex of the path to the eye.
  bool bounce(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const;
  // Light from the emissive triangle that was hit along a direction chosen with `density` per sr.
  glm::vec3 emitted(const Vertex& from, glm::vec3 direction, const scene::RayHit& hit, const SurfacePoint& at,
                    float density) const;

  const scene::Frame& frame_;
  const scene::View& view_;
  const scene::RayScene& rays_;
  Emitters emitters_;
  std::optional<Environment> environment_;
  float emitterShare_;  // of the rays aimed at emitters and environment
  Materials materials_;
  uint32_t depth_;
};

}  // namespace fovea::path_trace
