// The table `rayEmitters` (shaders/records/emitters.h): light sources that rays are aimed at.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene.h"

namespace fovea::scene {

// fullMaterials: whether surfaces have all that glTF says of them; then those of unlit materials are only seen.
std::vector<glm::uvec4> emitterTable(const Scene& scene, const Geometry& geometry, bool fullMaterials);

}  // namespace fovea::scene
