#include "framework/scene/lights.h"

#include <algorithm>
#include <cmath>

namespace fovea::scene {

SpotCone spotCone(const Light& light) {
  const float inner = std::cos(light.innerConeAngle);
  return {inner, std::min(std::cos(light.outerConeAngle), inner - 1e-4f)};
}

LightSample sampleLight(const Light& light, glm::vec3 position) {
  const glm::vec3 intensity = light.color * light.intensity;
  if (light.type == LightType::Directional) return {intensity, -light.direction, kFarAway};
  const glm::vec3 d = light.position - position;
  const float d2 = std::max(glm::dot(d, d), 1e-12f);
  const float distance = std::sqrt(d2);
  const glm::vec3 direction = d / distance;
  float falloff = 1.0f / d2;
  if (light.type == LightType::Spot) {
    const SpotCone cone = spotCone(light);
    const float s =
        std::clamp((glm::dot(-direction, light.direction) - cone.cosOuter) * cone.scale(), 0.0f, 1.0f);
    falloff *= s * s;
  }
  if (light.range > 0) {
    const float x = distance / light.range;
    falloff *= std::clamp(1.0f - x * x * x * x, 0.0f, 1.0f);
  }
  return {intensity * falloff, direction, distance};
}

uint32_t shadowLayers(const Light& light) { return light.type == LightType::Point ? 6 : 1; }

uint32_t shadowLayers(std::span<const Light> lights) {
  uint32_t layers = 0;
  for (const Light& light : lights) layers += shadowLayers(light);
  return layers;
}

uint32_t mostShadowTexels(uint32_t layers) {
  constexpr uint64_t kTexels = uint64_t(1) << 27;
  return uint32_t(std::sqrt(double(kTexels) / std::max(layers, 1u)));
}

}  // namespace fovea::scene
