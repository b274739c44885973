// What the records and shadow maps of lights need.
#pragma once

#include <span>

#include "framework/scene/scene.h"

namespace fovea::scene {

// Factor from radiance to light as passes store it (Frame::preExposure). It is a power of two, so that it rounds nothing.
float preExposure(const Scene& scene);

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
