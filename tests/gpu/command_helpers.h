// Helpers for recording commands that several GPU tests share.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"

namespace fovea::test {

inline const gpu::ReflectedBinding& binding(const gpu::Pipeline& pipeline, const std::string& name) {
  for (const gpu::ReflectedBinding& b : pipeline.interface().bindings) {
    if (b.name == name) return b;
  }
  throw std::runtime_error("no binding " + name);
}

// A write to the binding of this name. The caller sets the resource.
inline VkWriteDescriptorSet write(const gpu::Pipeline& pipeline, const std::string& name) {
  const gpu::ReflectedBinding& b = binding(pipeline, name);
  VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  w.dstBinding = b.binding;
  w.descriptorCount = 1;
  w.descriptorType = gpu::descriptorType(b.kind);
  return w;
}

inline void barrier(VkCommandBuffer cmd, VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess,
                    VkPipelineStageFlags2 dstStage, VkAccessFlags2 dstAccess) {
  VkMemoryBarrier2 b{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, srcStage, srcAccess, dstStage, dstAccess};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &b;
  vkCmdPipelineBarrier2(cmd, &info);
}

inline void layoutBarrier(VkCommandBuffer cmd, const gpu::Image& image, VkImageLayout from,
                          VkImageLayout to) {
  VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  b.srcStageMask = b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  b.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.oldLayout = from;
  b.newLayout = to;
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  b.image = image.handle();
  b.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &b;
  vkCmdPipelineBarrier2(cmd, &info);
}

template <class T>
std::vector<T> as(const std::vector<std::byte>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

template <class T>
std::vector<T> as(std::span<const std::byte> bytes) {
  return as<T>(std::vector<std::byte>(bytes.begin(), bytes.end()));
}

}  // namespace fovea::test
