// What a light does at a point: the one definition on the CPU, the same as sampleLight in shaders/common/scene.glsl.
#pragma once

#include <span>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct LightSample {
  glm::vec3 irradiance{0};  // on a surface that faces the light, W/m^2; nothing in between
  glm::vec3 direction{0};   // unit, to the light
  float distance = 0;       // m; directional: kFarAway
};

inline constexpr float kFarAway = 1e30f;

// Spot: saturate((cos t - cos outer) / (cos inner - cos outer))^2. A range above 0 adds the window that
// KHR_lights_punctual recommends, saturate(1 - (d / range)^4).
LightSample sampleLight(const Light& light, glm::vec3 position);

// Shadow-map layers: directional 1, spot 1, point 6; a light's layers follow those of the lights before it.
uint32_t shadowLayers(const Light& light);
uint32_t shadowLayers(std::span<const Light> lights);

// Cosines of the cone, outer below inner also where a file gives equal angles.
struct SpotCone {
  float cosInner = 1, cosOuter = 0;
  float scale() const { return 1.0f / (cosInner - cosOuter); }
};
SpotCone spotCone(const Light& light);

}  // namespace fovea::scene
