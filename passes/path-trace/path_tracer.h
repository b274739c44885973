// An unbiased path tracer over the pixels of a view, on all cores.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::path_trace {

struct PathTraceSettings {
  // Edges of the longest path: 1 is emission, 2 direct light, each further edge one indirect bounce.
  uint32_t depth = 4;
  uint32_t parts = 1, part = 0;  // only every parts-th row is traced, from row `part` on
  uint32_t samples = 2000;       // per pixel, at least 2
  uint32_t seed = 0;
  uint32_t threads = 0;      // 0 uses one per core
  bool independent = false;  // independent random numbers; if false, Owen-scrambled Sobol' points
  bool box = false;          // rays through the whole pixel; if false, through its centre
  bool full = false;         // full materials (passes/path-trace/bsdf.h); if false, diffuse ones
  float unit = 1;            // factor on radiance in the images
  // Called from time to time on the calling thread, with the share of the work that is done. Returning false stops
  // the run soon, with fewer samples.
  std::function<bool(double)> progress;
};

// rgb with a = 1; rows from the top. Each image has view.size pixels or is empty.
struct PathTraceImages {
  std::span<glm::vec4> radiance;  // direct + indirect, W/(sr m^2)
  // Emission plus light from the scene's lights reflected once; in the background the environment.
  std::span<glm::vec4> direct;
  std::span<glm::vec4>
      indirect;  // all other light; that of emissive triangles and of an environment map is here
  std::span<glm::vec4> variance;      // estimated variance of the mean `radiance`
  std::span<glm::vec4> halfA, halfB;  // radiance from each half of the samples; the halves are independent
};

struct PathTraceStatistics {
  uint64_t paths = 0, rays = 0;
  double samples = 0;  // per pixel, mean
};

// The result is identical bit for bit whatever the number of threads. The samples of a pixel belong in turn to up to
// 16 independent scrambles (sampling is low-discrepancy within each), and the variance is that between the scrambles;
// with independent sampling it is that between the samples. A sample is in half A or B if its scramble, or its own
// number, is even or odd. Samples are taken in rounds over the whole image, so that a run stopped early leaves an
// image with fewer samples, at least 2 per pixel.
PathTraceStatistics tracePaths(const scene::Frame& frame, const scene::View& view,
                               const scene::RayScene& rays, const PathTraceSettings& settings,
                               const PathTraceImages& images);

}  // namespace fovea::path_trace
