// Emissive triangles as light sources of a path tracer: chosen by power, points uniform over the area.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"

namespace fovea::passes {

struct EmitterPoint {
  glm::vec3 position{0};  // world space, m
  glm::vec3 normal{0};    // unit, on the side that was asked for
  glm::vec3 radiance{0};  // W/(sr m^2); 0: the triangle does not shine to that side
  float density = 0;      // of the choice, per m^2
};

class Emitters {
 public:
  explicit Emitters(const scene::Frame& frame);
  bool empty() const { return triangles_.empty(); }
  // A point that may light `receiver`. choice, u, v: uniform in [0, 1).
  EmitterPoint sample(glm::vec3 receiver, float choice, float u, float v) const;
  // The density with which sample() makes points of a triangle, per m^2; 0 for those that do not shine.
  float density(uint32_t triangle) const { return density_.empty() ? 0.0f : density_[triangle]; }

 private:
  const scene::Frame& frame_;
  std::vector<uint32_t> triangles_;
  std::vector<double> cumulative_;  // power up to and with each of them
  std::vector<float> density_;      // of every triangle of the geometry; empty when none shines
};

}  // namespace fovea::passes
