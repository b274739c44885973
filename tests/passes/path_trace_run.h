// Shared by the tests of the path tracer: rendering a picture, and its mean.
#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/path_tracer.h"
#include "tests/support/shapes.h"

namespace fovea::test {

constexpr double kPi = glm::pi<double>();

using path_trace::PathTraceSettings;

struct Traced {
  glm::uvec2 size{0};
  std::vector<glm::vec4> radiance, direct, indirect, variance, halfA, halfB;
  path_trace::PathTraceStatistics statistics;
};

inline Traced trace(const scene::Scene& s, uint32_t side, const PathTraceSettings& settings) {
  const scene::Geometry g = flatten(s);
  const scene::Frame frame = makeFrame(s, g, {side, side}, 0, 1);
  const scene::RayScene rays(s, g, settings.full ? scene::Passing::Met : scene::Passing::Never);
  Traced t;
  t.size = {side, side};
  for (auto* image : {&t.radiance, &t.direct, &t.indirect, &t.variance, &t.halfA, &t.halfB})
    image->resize(size_t(side) * side);
  t.statistics = tracePaths(frame, frame.views[0], rays, settings,
                            {t.radiance, t.direct, t.indirect, t.variance, t.halfA, t.halfB});
  return t;
}

inline PathTraceSettings independent(uint32_t depth, uint32_t samples, uint32_t seed = 1) {
  PathTraceSettings settings;
  settings.depth = depth;
  settings.samples = samples;
  settings.seed = seed;
  settings.independent = true;
  return settings;
}

inline glm::dvec3 meanOf(const std::vector<glm::vec4>& image) {
  glm::dvec3 sum(0);
  for (const glm::vec4& v : image) sum += glm::dvec3(v);
  return sum / double(image.size());
}

// Standard error of the mean over the picture; pixels are independent of each other.
inline glm::dvec3 errorOfMean(const Traced& t) {
  return glm::sqrt(meanOf(t.variance) / double(t.variance.size()));
}

inline void lookAlong(scene::Scene& s, glm::vec3 eye, glm::vec3 towards, float verticalFov) {
  s.cameras.resize(1);
  s.cameras[0].position = eye;
  const glm::vec3 d = glm::normalize(towards);
  s.cameras[0].orientation =
      glm::quatLookAt(d, std::abs(d.y) > 0.9f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0));
  s.cameras[0].verticalFov = verticalFov;
}

// Looks down on the plane y = 0; pixel -> point of the plane.
inline scene::Scene plane(glm::vec3 rho) {
  scene::Scene s;
  addMaterial(s, rho);
  addQuad(s, 0, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  lookAlong(s, {0, 3, 0}, {0, -1, 0}, 1);
  return s;
}

}  // namespace fovea::test
