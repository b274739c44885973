// Emissive triangles and the environment map on the device, as light sources at which shaders aim rays
// (shaders/rays/emitters.glsl). Private to framework/scene.
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

class EmitterTables {
 public:
  // Builds the tree of the emitters as they are and uploads it. fullMaterials: as in Emitters. If `wanted` is false,
  // there are no light sources. Throws Error(OutOfMemory) if the tables do not fit.
  EmitterTables(gpu::Device& device, const Scene& scene, const Geometry& geometry, bool fullMaterials,
                bool wanted);
  ~EmitterTables();

  // Fits the tree to new positions of the vertices, which compute commands have written before; its order stays.
  // triangles: as in GpuScene. The caller's barriers must order the commands (compute) before all readers of the
  // tables.
  void record(VkCommandBuffer cmd, gpu::Buffer& positions, gpu::Buffer& triangles);

  gpu::Buffer& texels() const;  // uvec4 each; shaders/records/emitters.h

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::scene
