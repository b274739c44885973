// An unbiased diffuse path tracer over the pixels of a view, on all cores.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::passes {

struct PathTraceSettings {
  uint32_t depth =
      4;  // edges of the longest path: 1 emission, 2 direct light, each further one an indirect bounce
  uint32_t samples = 2000;  // a pixel, at least 2
  uint32_t seed = 0;
  uint32_t threads = 0;      // 0: one a core
  bool independent = false;  // independent random numbers; else Owen-scrambled Sobol' points
  bool box = false;          // rays through the whole pixel; else through its centre
  // Called now and then on the thread that called, with the share that is done; false: stop soon, with fewer
  // samples.
  std::function<bool(double)> progress;
};

// rgb, a: 1; rows from the top; each of view.size pixels, or empty.
struct PathTraceImages {
  std::span<glm::vec4> radiance;  // direct + indirect, W/(sr m^2)
  std::span<glm::vec4>
      direct;  // emission plus light of the scene's lights reflected once; background: the environment
  std::span<glm::vec4> indirect;      // all else; light of emissive triangles is here, as VPLs carry it
  std::span<glm::vec4> variance;      // estimated variance of the mean `radiance`
  std::span<glm::vec4> halfA, halfB;  // radiance from either half of the samples, independent of each other
};

struct PathTraceStatistics {
  uint64_t paths = 0, rays = 0;
  double samples = 0;  // a pixel, mean
};

// The same bits whatever the number of threads. Samples of a pixel belong to up to 16 independent scrambles
// in turn (sampling is low-discrepancy within each), and the variance is that between them; with independent
// sampling it is that between the samples. A sample is in half A or B as its scramble, or its own number, is
// even or odd. Samples are taken in rounds over the whole picture, so that a run that is stopped early leaves
// a picture with fewer samples, at least 2 a pixel.
PathTraceStatistics tracePaths(const scene::Frame& frame, const scene::View& view,
                               const scene::RayScene& rays, const PathTraceSettings& settings,
                               const PathTraceImages& images);

}  // namespace fovea::passes
