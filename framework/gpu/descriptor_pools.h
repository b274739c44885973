// Ordinary descriptor sets in place of push descriptors, for GPU-assisted validation only.
#pragma once

#include <vulkan/vulkan.h>

#include <unordered_map>
#include <vector>

namespace fovea::gpu {

// Validation layer 1.3.239 takes push descriptors for uninitialised ones in its instrumented shaders and reports
// every access. In that mode a "push" allocates, writes and binds a set; the sets live as long as the device.
class DescriptorPools {
 public:
  explicit DescriptorPools(VkDevice device) : device_(device) {}
  ~DescriptorPools();
  DescriptorPools(const DescriptorPools&) = delete;
  DescriptorPools& operator=(const DescriptorPools&) = delete;

  // Registers the layout of set 0 of a pipeline layout.
  void remember(VkPipelineLayout layout, VkDescriptorSetLayout set) { layouts_[layout] = set; }
  void bind(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout, uint32_t set,
            std::vector<VkWriteDescriptorSet> writes);

 private:
  VkDescriptorSet allocate(VkDescriptorSetLayout layout);
  VkDevice device_;
  std::vector<VkDescriptorPool> pools_;
  std::unordered_map<VkPipelineLayout, VkDescriptorSetLayout> layouts_;
};

}  // namespace fovea::gpu
