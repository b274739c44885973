// Evaluates a light at a point. This is the one definition on the CPU; sampleLight in shaders/scene/scene.glsl
// does the same.
#pragma once

#include <span>

#include "framework/scene/scene.h"

namespace fovea::scene {

struct LightSample {
  glm::vec3 irradiance{0};  // on an unoccluded surface facing the light, W/m^2
  glm::vec3 direction{0};   // unit, to the light
  float distance = 0;       // m; kFarAway for a directional light
};

inline constexpr float kFarAway = 1e30f;

// The falloff of a spot light is saturate((cos t - cos outer) / (cos inner - cos outer))^2. A range above 0 adds the
// window that KHR_lights_punctual recommends, saturate(1 - (d / range)^4).
LightSample sampleLight(const Light& light, glm::vec3 position);

// Number of layers in the shadow map: 1 for a directional or spot light, 6 for a point light. The layers of a light
// follow those of the lights before it.
uint32_t shadowLayers(const Light& light);
uint32_t shadowLayers(std::span<const Light> lights);

// Width and height to which shadow maps with so many layers are limited, texels: with it all of them have at most 2^27
// texels, which are 512 MiB. Two images of them are kept.
uint32_t mostShadowTexels(uint32_t layers);

// Cosines of the half angles of the cone. The outer cosine is below the inner one even if a file gives equal angles.
struct SpotCone {
  float cosInner = 1, cosOuter = 0;
  float scale() const { return 1.0f / (cosInner - cosOuter); }
};
SpotCone spotCone(const Light& light);

}  // namespace fovea::scene
