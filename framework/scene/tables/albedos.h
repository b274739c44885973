#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace fovea::scene {

// The tables of albedos of a lobe of GGX microfacets (shaders/records/scene.h), row by row: for a Fresnel reflection of
// F0 + (F90 - F0) * curve(cosine), the albedo of single scattering is F0 * (all - high) + F90 * high ("split sum", Karis
// 2013). x: all, the albedo of a perfect mirror; y, z: high of Schlick's curve, for metals, and of the exact curve of a
// dielectric with an index of refraction of 1.5.
const std::vector<glm::vec4>& lobeAlbedos();

}  // namespace fovea::scene
