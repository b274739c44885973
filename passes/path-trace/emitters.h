// Emissive triangles as light sources of a path tracer, chosen by power, with points uniform over their area.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::passes {

struct EmitterPoint {
  glm::vec3 position{0};  // world space, m
  glm::vec3 normal{0};    // unit, on the requested side
  glm::vec3 radiance{0};  // W/(sr m^2); 0 if the triangle does not emit to that side
  float density = 0;      // probability density of the choice, per m^2
};

class Emitters {
 public:
  explicit Emitters(const scene::Frame& frame);
  bool empty() const { return triangles_.empty(); }
  // A point that may light `receiver`. choice, u, v: uniform in [0, 1).
  EmitterPoint sample(glm::vec3 receiver, float choice, float u, float v) const;
  // Density with which sample() chooses points of a triangle, per m^2; 0 for triangles that do not emit.
  float density(uint32_t triangle) const { return density_.empty() ? 0.0f : density_[triangle]; }

 private:
  const scene::Frame& frame_;
  std::vector<uint32_t> triangles_;
  std::vector<double> cumulative_;  // power up to and including each of them
  std::vector<float> density_;      // for every triangle of the geometry; empty if none emits
};

}  // namespace fovea::passes
