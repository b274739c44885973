// Where surfaces let light through: holes of alpha masks, and with full materials alphaMode BLEND and thin glass. The
// same as shaders/common/passage.glsl.
#pragma once

#include "framework/scene/scene.h"

namespace fovea::scene {

// The share of light that the surface stops before any of it enters glass: alpha of BLEND, 0 or 1 of MASK, else 1.
float coverage(const Scene& scene, const Material& material, glm::vec2 uv);

// The share of light that goes straight through thin glass, as the mean of its colours; at most kMostPassed. Textures
// are looked up by the first texture coordinates, and a coat is left out. cosine: between light and normal.
float passage(const Scene& scene, const Material& material, glm::vec2 uv, float cosine);

// What glass makes of the light that goes through it.
glm::vec3 glassColor(const Scene& scene, const Material& material, glm::vec2 uv);

// With full materials.
inline bool letsLightThrough(const Material& m) { return m.blended || m.transmission > 0; }

}  // namespace fovea::scene
