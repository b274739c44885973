// The table `sceneMaterials` (shaders/records/scene.h): a MaterialRecord for each material, then what full materials need.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "framework/scene/scene.h"
#include "framework/scene/tables/full_materials.h"

namespace fovea::scene {

struct MaterialTable {
  std::vector<glm::vec4> texels;
  FullMaterials full;
};

// Where a texture lies: its upper left corner in a page, texels, and the page; nullopt if it is left out.
using TexturePlace = std::function<std::optional<glm::uvec3>(uint32_t texture)>;

// fullMaterials: whether materials have all that glTF says of them.
MaterialTable materialTable(const Scene& scene, const Geometry& geometry, bool fullMaterials,
                            const TexturePlace& place);

}  // namespace fovea::scene
