// Light from all around the scene: the colours of its environment map and directions in proportion to them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/environment/environment_map.h"

namespace fovea::path_trace {

// One of several things, each in proportion to its weight.
class Distribution {
 public:
  // weights: not below 0.
  explicit Distribution(const std::vector<float>& weights);
  double sum() const { return sum_; }
  float probability(uint32_t index) const { return shares_[index + 1] - shares_[index]; }
  struct Choice {
    uint32_t index = 0;
    float within = 0;  // uniform in [0, 1)
  };
  // u: uniform in [0, 1). The sum must be above 0.
  Choice choose(float u) const;

 private:
  std::vector<float> shares_;  // of all before each, from 0 to 1
  double sum_ = 0;
};

// The map is seen and placed as scene::EnvironmentMap says; it has to outlive this.
class Environment {
 public:
  explicit Environment(const scene::EnvironmentMap& map);

  // Directions are unit.
  glm::vec3 radiance(glm::vec3 direction) const;
  // The probability density with which sample() chooses a direction, per sr; 0 only where the map is black.
  float density(glm::vec3 direction) const;
  struct Sample {
    glm::vec3 direction{0}, radiance{0};
    float density = 0;  // 0 if the map is black
  };
  // u, v: uniform in [0, 1).
  Sample sample(float u, float v) const;

 private:
  glm::vec2 texelsFromCorner(glm::vec3 direction) const;
  const glm::vec3& texel(int x, int y) const;
  float solidAngle(uint32_t row) const;  // of one of its texels, sr
  float densityIn(uint32_t x, uint32_t y) const {
    return rows_.probability(y) * columns_[y].probability(x) / solidAngle(y);
  }

  const scene::EnvironmentMap& map_;
  std::vector<Distribution> columns_;  // of each row
  Distribution rows_;
};

}  // namespace fovea::path_trace
