#include "framework/scene/lights.h"

#include <algorithm>
#include <cmath>

namespace fovea::scene {

float preExposure(const Scene& scene) {
  if (scene.preExposure > 0) return scene.preExposure;
  constexpr float kMostStops = 100;  // beyond them, factors and their squares would leave the range of floats
  return std::exp2(std::clamp(std::round(std::log2(scene.exposure)), -kMostStops, kMostStops));
}

SpotCone spotCone(const Light& light) {
  const float inner = std::cos(light.innerConeAngle);
  return {inner, std::min(std::cos(light.outerConeAngle), inner - 1e-4f)};
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
