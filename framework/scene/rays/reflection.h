// How a surface that a ray has met reflects light in one direction.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "framework/scene/materials/bsdf.h"
#include "framework/scene/materials/surface_materials.h"

namespace fovea::scene {

// Of a diffuse surface all there is to know is its reflectance. That of a full material is asked for each direction
// from which light arrives.
class Reflection {
 public:
  explicit Reflection(glm::vec3 rho) : rho_(rho) {}
  // Of a full material. out: direction of the reflected light, unit, world space; leastRoughness: the surface is
  // treated as at least this rough; factor: on all that it reflects.
  Reflection(const SurfacePoint& point, glm::vec3 out, float leastRoughness, glm::vec3 factor);

  bool full() const { return full_; }
  glm::vec3 rho() const { return rho_; }  // of a diffuse surface

  // The rest is for full materials; directions are unit, in world space.
  glm::vec3 normal() const { return frame_[2]; }  // of shading
  glm::vec3 evaluate(glm::vec3 direction) const;  // f cos, with the factor, per sr
  struct Sample {
    glm::vec3 direction{0};
    glm::vec3 weight{0};  // evaluate(direction) / density
    float density = 0;    // per sr
  };
  std::optional<Sample> sample(float choice, glm::vec2 u) const;  // as Bsdf::sample()
  float density(glm::vec3 direction) const;                       // of sample(), per sr

 private:
  glm::vec3 rho_{0};
  bool full_ = false;
  glm::vec3 factor_{1};
  glm::mat3 frame_{1};        // of the shading normal
  std::optional<Bsdf> bsdf_;  // none of an unlit material, which reflects nothing
};

}  // namespace fovea::scene
