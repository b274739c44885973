#include "framework/scene/device/rays/ray_tables.h"

#include "framework/gpu/device.h"

namespace fovea::scene {

std::unique_ptr<RayTables> rayTables(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                                     gpu::Buffer& positions, bool wanted) {
  return device.lacks(VK_KHR_RAY_QUERY_EXTENSION_NAME)
             ? rayTrees(device, scene, geometry, positions, wanted)
             : rayStructures(device, scene, geometry, positions, wanted);
}

}  // namespace fovea::scene
