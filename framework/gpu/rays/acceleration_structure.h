// Acceleration structures, in which shaders trace rays by ray queries on devices that have VK_KHR_ray_query.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <string>

#include "framework/gpu/resources.h"

namespace fovea::gpu {

// How buffers must be usable that acceleration structures are built from.
inline constexpr VkBufferUsageFlags kBuildInputUsage =
    VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

struct TriangleInput {
  const Buffer* positions = nullptr;  // vec4 each, of which xyz counts
  uint32_t vertices = 0;
  const Buffer* indices = nullptr;  // three 32-bit numbers of vertices for each triangle
  uint32_t first = 0, count = 0;    // triangles
  bool opaque = true;               // if not, shaders decide about each hit
};

// Move-only. The buffers that it is built from must live as long as it does, unless it is built once only.
class AccelerationStructure {
 public:
  AccelerationStructure() noexcept;
  // Of triangles. moves: whether it is going to be updated. Throws Error(OutOfMemory).
  AccelerationStructure(Device& device, const std::string& name, const TriangleInput& triangles, bool moves);
  // Of `count` records VkAccelerationStructureInstanceKHR.
  AccelerationStructure(Device& device, const std::string& name, const Buffer& instances, uint32_t count);
  AccelerationStructure(AccelerationStructure&&) noexcept;
  AccelerationStructure& operator=(AccelerationStructure&&) noexcept;
  ~AccelerationStructure();

  // The caller's barriers must order these commands (stage ACCELERATION_STRUCTURE_BUILD) after the writes of what they
  // read and before the readers.
  void build(VkCommandBuffer cmd);
  void update(VkCommandBuffer cmd);  // after the vertices have moved

  VkAccelerationStructureKHR handle() const;
  VkDeviceAddress address() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::gpu
