// Where surfaces let light through: holes of alpha masks, and with full materials alphaMode BLEND and thin glass. The
// same as shaders/materials/passage.glsl.
#pragma once

#include <cstdint>

#include "framework/scene/scene.h"

namespace fovea::scene {

// The share of light that the surface stops before any of it enters glass: alpha of BLEND, 0 or 1 of MASK, else 1.
float coverage(const Scene& scene, const Material& material, glm::vec2 uv);

// The share of light that goes straight through thin glass, as the mean of its colours; at most kMostPassed. Textures
// are looked up by the first texture coordinates, and a coat is left out. cosine: between light and normal.
float passage(const Scene& scene, const Material& material, glm::vec2 uv, float cosine);

// The colour that light takes on in glass, relative to the mean of its channels.
glm::vec3 glassTint(const Scene& scene, const Material& material, glm::vec2 uv);

// The share of light that passes the surface in either way, by channels.
glm::vec3 transmittance(const Scene& scene, const Material& material, glm::vec2 uv, float cosine);

// A number in [0, 1) for a ray through a pixel, or towards a texel, at one triangle: the ray passes if the number is
// not below the share of light that the triangle stops. Over neighbouring pixels and over turns, such as frames, the
// numbers are a low-discrepancy sequence, so that a few of them tell the share. key: a hash of the triangle, which also
// chooses one of several sequences, so that surfaces behind each other let rays pass independently.
float passageChance(uint32_t key, glm::uvec2 pixel, uint32_t turn);

// With full materials.
inline bool letsLightThrough(const Material& m) { return m.blended || m.transmission > 0; }

}  // namespace fovea::scene
