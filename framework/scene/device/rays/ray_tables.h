// The scene's bounding volume hierarchies on the device, where shaders trace rays (shaders/rays/trace.glsl): one
// of the triangles that never move, and one of all others. Private to framework/scene.
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
  // Builds the trees of the geometry as it is and uploads them. If `wanted` is false, the tables are those of a scene
  // without triangles. Throws Error(OutOfMemory) if a table does not fit.
  RayTables(gpu::Device& device, const Scene& scene, const Geometry& geometry, bool wanted);
  ~RayTables();

  // Fits the tree of what moves to new positions of the vertices. The caller's barriers must order the commands
  // (compute) after the writes of the positions and before all readers of the tables.
  void record(VkCommandBuffer cmd, gpu::Buffer& positions);

  gpu::Buffer& nodes() const;  // BvhNode each
  // uvec4 in the order of leaves: three vertices, then the triangle and kRayHoles.
  gpu::Buffer& triangles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
