// Light along single paths between diffuse surfaces. At depth 4, that is direct light plus two indirect bounces, the
// ground truth of the paper.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/path-trace/emitters.h"
#include "passes/path-trace/environment.h"
#include "passes/path-trace/surface_table.h"

namespace fovea::path_trace {

// Random numbers of one path, addressed by an index k.
struct PathSampler {
  bool independent = false;  // if false, Owen-scrambled Sobol' points
  uint32_t stream = 0;       // independent: stream of the path; else: the scramble
  uint32_t index = 0;        // index of the point in its scramble
  float number(uint32_t k) const;
  std::array<float, 2> pair(uint32_t k) const;  // numbers k and k + 1; k must be a multiple of 4
};

// The ray through `pixel` (pixels, centres at +0.5), from clip-space depth 0 (near plane) to w (far plane); distances
// are in lengths of its direction.
scene::Ray eyeRay(const scene::View& view, glm::vec2 pixel);

// The share of the rays aimed at light that go to emissive triangles; the others go to the environment map.
float emitterShare(const scene::Frame& frame, const Emitters& emitters);

// A surface as the path that reached it sees it.
struct PathVertex {
  glm::vec3 position{0};         // world space, m
  glm::vec3 origin{0};           // origin of rays that leave it, just off the surface
  glm::vec3 normal{0}, face{0};  // shading and geometric, unit, on the viewer's side
  glm::vec3 reflectance{0};
};

struct EyePoint {
  bool surface = false;
  PathVertex vertex;
  // Light that reaches the eye from the lights after one reflection, plus emission; in the background the environment.
  glm::vec3 direct{0};
};

// A single-sided material has one face. The eye looks through its back, as in pass gbuffer. For light the back is
// black: it stops rays (as in pass shadow-map), reflects nothing and does not emit.
//
// Bounces are cosine-weighted around the shading normal. Directions below the surface itself carry no light, as in
// pass direct.
class PathIntegrator {
 public:
  using EyePoint = path_trace::EyePoint;
  PathIntegrator(const scene::Frame& frame, const scene::View& view, const scene::RayScene& rays,
                 uint32_t depth);

  // Returns the surface that the eye sees at `pixel` (pixels, centres at +0.5), between the near and the far plane.
  EyePoint look(glm::vec2 pixel, uint64_t& rays) const;
  // Samples the light that reaches the eye from there by all other paths of at most `depth` edges: at least two
  // reflections of light from the scene's lights, at least one from emissive triangles and the environment map.
  // light[i] is that of path random[i]. The paths are traced together, so that each waits for memory while the others
  // proceed.
  static constexpr size_t kMaxPaths = 32;
  void indirect(const PathVertex& first, std::span<const PathSampler> random, std::span<glm::vec3> light,
                uint64_t& rays) const;

  // For benchmarks: records every ray of indirect(). A shadow ray has its end, finite or infinite, as it is traced.
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
  // `direction` is the unit direction of the ray that hit.
  PathVertex vertexAt(const scene::SurfaceHit& s,
                      glm::vec3 direction) const;  // fills everything except the reflectance
  // Steps of a path from one vertex to the next; each returns false if the path ends.
  bool leave(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const;
  bool arrive(Path& path, uint32_t edges) const;
  bool reflect(Path& path) const;
  void bounce(Wave& wave, uint32_t edges, uint64_t& rays) const;
  void reflectLast(Wave& wave, uint32_t edges, uint64_t& rays) const;
  // Whether there is light that is not one of the scene's lights.
  bool emits() const { return !emitters_.empty() || environment_; }
  // Without it the last edge is a shadow ray.
  bool lastByLight(uint32_t edges) const { return !emits() && edges + 1 == depth_; }
  // Irradiance of one light on a vertex, ignoring occlusion.
  glm::vec3 unshadowed(const scene::Light& light, const PathVertex& v, scene::Ray& shadowRay) const;
  glm::vec3 allLights(const PathVertex& v, uint64_t& rays) const;  // irradiance
  // The same on average, using random number k where there is a choice.
  glm::vec3 oneLight(const PathVertex& v, const PathSampler& random, uint32_t k, uint64_t& rays) const;
  glm::vec3 environmentLight(const PathVertex& v, float u1, float u2, uint64_t& rays) const;
  // Irradiance from emissive triangles or the environment map, divided by pi.
  glm::vec3 emitterLight(const PathVertex& v, float choice, float u1, float u2, uint64_t& rays) const;

  const scene::Frame& frame_;
  const scene::View& view_;
  const scene::RayScene& rays_;
  Emitters emitters_;
  std::optional<Environment> environment_;
  float emitterShare_;  // of the rays aimed at emitters and environment
  SurfaceTable surfaces_;
  uint32_t depth_;
  std::vector<TracedRay>* record_ = nullptr;
};

}  // namespace fovea::path_trace
