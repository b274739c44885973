#include "framework/scene/rays/reflection.h"

#include <algorithm>

#include "framework/scene/rays/directions.h"

namespace fovea::scene {

Reflection::Reflection(const SurfacePoint& point, glm::vec3 out, float leastRoughness, glm::vec3 factor)
    : full_(true), factor_(factor), frame_(orthonormalFrame(normalTowards(point, out))) {
  if (point.unlit) return;
  BsdfParameters material = point.bsdf;
  for (float* roughness : {&material.roughness, &material.clearcoatRoughness})
    *roughness = std::max(*roughness, leastRoughness);
  bsdf_.emplace(material, glm::normalize(toLocal(frame_, out)));
}

glm::vec3 Reflection::evaluate(glm::vec3 direction) const {
  return bsdf_ ? factor_ * bsdf_->evaluate(toLocal(frame_, direction)) : glm::vec3(0);
}

std::optional<Reflection::Sample> Reflection::sample(float choice, glm::vec2 u) const {
  const auto s = bsdf_ ? bsdf_->sample(choice, u.x, u.y) : std::nullopt;
  if (!s) return std::nullopt;
  return Sample{toWorld(frame_, s->in), factor_ * s->weight, s->density};
}

float Reflection::density(glm::vec3 direction) const {
  return bsdf_ ? bsdf_->density(toLocal(frame_, direction)) : 0.0f;
}

}  // namespace fovea::scene
