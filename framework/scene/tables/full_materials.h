// The data of full materials on the device beyond the MaterialRecords. Private to framework/scene.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/scene.h"
#include "shaders/records/scene.h"

namespace fovea::scene {

// Where the parts start in `sceneMaterials`, as in FrameBlock; all 0 if materials are diffuse.
struct FullMaterials {
  uint32_t firstSurface = 0, firstAlbedo = 0, firstTangent = 0, firstDetail = 0;
  bool transparent = false;  // whether any material lets a part of the light through
};

// Appends SurfaceRecords, tables of albedos, and tangents and details of vertices where the scene has any.
FullMaterials appendFullMaterials(const Scene& scene, const Geometry& geometry,
                                  const std::function<TextureRecord(const TextureUse&)>& textureEntry,
                                  std::vector<glm::vec4>& texels);

}  // namespace fovea::scene
