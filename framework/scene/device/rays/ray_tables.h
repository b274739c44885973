// The triangles of a scene on the device, as shaders trace rays through them (shaders/rays/trace.glsl). Private to
// framework/scene.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>

#include "framework/scene/scene.h"

namespace fovea::gpu {
class Device;
class Buffer;
}  // namespace fovea::gpu

namespace fovea::scene {

class RayTables {
 public:
  RayTables() = default;
  RayTables(const RayTables&) = delete;
  RayTables& operator=(const RayTables&) = delete;
  virtual ~RayTables() = default;

  // Follows the vertices that have moved. The caller's barriers must order the commands (compute) after the writes of
  // the positions and before all readers of the tables.
  virtual void record(VkCommandBuffer cmd) = 0;

  // What binding 11 is: an acceleration structure, or if there is none, a buffer of BvhNode.
  virtual VkAccelerationStructureKHR structure() const = 0;
  virtual gpu::Buffer* nodes() = 0;
  // Binding 12: what the primitives are that rays hit (rayTriangles in rays/hardware.glsl and rays/bvh.glsl).
  virtual gpu::Buffer& triangles() = 0;
};

// Acceleration structures on devices with VK_KHR_ray_query, bounding volume hierarchies elsewhere, of the geometry as
// it is. positions: of all vertices, which must live as long as the tables. If `wanted` is false, the tables are those
// of a scene without triangles. Throws Error(OutOfMemory) if a table does not fit.
std::unique_ptr<RayTables> rayTables(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                                     gpu::Buffer& positions, bool wanted);

// Whether rays that meet the triangle have to look at its alpha mask.
inline bool mayHaveHoles(const Scene& scene, const Triangle& triangle) {
  const uint32_t material = triangle.material();
  return material < scene.materials.size() && scene.materials[material].masked;
}

// The two kinds of them.
std::unique_ptr<RayTables> rayStructures(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                                         gpu::Buffer& positions, bool wanted);
std::unique_ptr<RayTables> rayTrees(gpu::Device& device, const Scene& scene, const Geometry& geometry,
                                    gpu::Buffer& positions, bool wanted);

}  // namespace fovea::scene
