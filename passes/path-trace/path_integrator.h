// The light of single paths: what METHOD section 1 calls a path tracer of depth 4, diffuse surfaces only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/path-trace/emitters.h"
#include "passes/path-trace/surface_table.h"

namespace fovea::passes {

// Random numbers of one path: number k.
struct PathSampler {
  bool independent = false;  // else Owen-scrambled Sobol' points
  uint32_t stream = 0;       // independent: of the path; else: the scramble
  uint32_t index = 0;        // of the point in its scramble
  float number(uint32_t k) const;
  std::array<float, 2> pair(uint32_t k) const;  // k and k + 1; k: a multiple of 4
};

// A surface as the path that reached it sees it.
struct PathVertex {
  glm::vec3 position{0};         // world space, m
  glm::vec3 origin{0};           // of rays that leave it, just off the surface
  glm::vec3 normal{0}, face{0};  // shading and geometric, unit, on the viewer's side
  glm::vec3 reflectance{0};
};

struct EyePoint {
  bool surface = false;
  PathVertex vertex;
  glm::vec3 direct{
      0};  // what reaches the eye from the lights after one reflection, plus emission; or the environment
};

// A single-sided material has one face: the eye looks through its back, as in pass gbuffer. For light the
// back is black: it stops rays (as in pass shadow-map), reflects nothing and does not shine.
//
// Bounces are cosine-weighted around the shading normal; directions below the surface itself carry nothing,
// the same as light from there does in pass direct.
class PathIntegrator {
 public:
  PathIntegrator(const scene::Frame& frame, const scene::View& view, const scene::RayScene& rays,
                 uint32_t depth);

  // What the eye sees at `pixel` (pixels, centres at +0.5), between the near and the far plane.
  EyePoint look(glm::vec2 pixel, uint64_t& rays) const;
  // Samples of the light that reaches the eye from there by all other ways of at most `depth` edges: at least
  // two reflections from the scene's lights, at least one from emissive triangles. light[i] is that of path
  // random[i]; they are traced side by side, so that each waits for the memory while the others are worked
  // on.
  static constexpr size_t kMaxPaths = 32;
  void indirect(const PathVertex& first, std::span<const PathSampler> random, std::span<glm::vec3> light,
                uint64_t& rays) const;

  // For benchmarks: every ray of indirect() is noted here, the shadow rays with a finite end or infinity as
  // they are.
  struct TracedRay {
    scene::Ray ray;
    bool shadow = false;
  };
  void record(std::vector<TracedRay>* to) { record_ = to; }

 private:
  struct Path;
  struct Wave;
  scene::RayHit intersect(const scene::Ray& ray, uint64_t& rays) const;
  bool occluded(const scene::Ray& ray, uint64_t& rays) const;
  // `direction`: unit, of the ray that hit.
  PathVertex vertexAt(const scene::SurfaceHit& s, glm::vec3 direction) const;  // all but the reflectance
  // The steps of a path from one vertex to the next; false: it ends.
  bool leave(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const;
  bool arrive(Path& path, uint32_t edges) const;
  bool reflect(Path& path) const;
  void bounce(Wave& wave, uint32_t edges, uint64_t& rays) const;
  void reflectLast(Wave& wave, uint32_t edges, uint64_t& rays) const;
  // Without emitters the last edge is a shadow ray.
  bool lastByLight(uint32_t edges) const { return emitters_.empty() && edges + 1 == depth_; }
  // Irradiance of one light on a vertex where nothing is in between.
  glm::vec3 unshadowed(const scene::Light& light, const PathVertex& v, scene::Ray& shadowRay) const;
  glm::vec3 allLights(const PathVertex& v, uint64_t& rays) const;  // irradiance
  // The same on average; takes random number k where there is a choice.
  glm::vec3 oneLight(const PathVertex& v, const PathSampler& random, uint32_t k, uint64_t& rays) const;
  glm::vec3 emitterLight(const PathVertex& v, float choice, float u1, float u2,
                         uint64_t& rays) const;  // / pi

  const scene::Frame& frame_;
  const scene::View& view_;
  const scene::RayScene& rays_;
  Emitters emitters_;
  SurfaceTable surfaces_;
  uint32_t depth_;
  std::vector<TracedRay>* record_ = nullptr;
};

}  // namespace fovea::passes
