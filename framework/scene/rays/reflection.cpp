#include "framework/scene/rays/reflection.h"

#include <algorithm>

#include "framework/shader_twins/paraboloid.h"

namespace fovea::scene {

Reflection::Reflection(const SurfacePoint& point, glm::vec3 out, float leastRoughness, glm::vec3 factor)
    : factor_(factor) {
  if (point.unlit) return;  // reflects nothing
  BsdfParameters material = point.bsdf;
  for (float* roughness : {&material.roughness, &material.clearcoatRoughness})
    *roughness = std::max(*roughness, leastRoughness);
  frame_ = orthonormalFrame(normalTowards(point, out));
  bsdf_.emplace(material, glm::normalize(toLocal(frame_, out)));
}

glm::vec3 Reflection::evaluate(glm::vec3 direction) const {
  return factor_ * bsdf_->evaluate(toLocal(frame_, direction));
}

std::optional<Reflection::Sample> Reflection::sample(float choice, glm::vec2 u) const {
  const std::optional<Bsdf::Sample> s = bsdf_->sample(choice, u.x, u.y);
  if (!s) return std::nullopt;
  return Sample{toWorld(frame_, s->in), factor_ * s->weight, s->density};
}

float Reflection::density(glm::vec3 direction) const { return bsdf_->density(toLocal(frame_, direction)); }

}  // namespace fovea::scene
