// Ordinary descriptor sets in place of push descriptors, for devices without them and for GPU-assisted validation.
#pragma once

#include <vulkan/vulkan.h>

#include <span>
#include <unordered_map>
#include <vector>

namespace fovea::gpu {

// A "push" takes a set, writes and binds it. The sets belong to the command buffer into which they are bound, and are
// reused when it begins again, so that a command buffer that repeats its commands allocates nothing.
//
// In its instrumented shaders, validation layer 1.3.239 takes push descriptors for uninitialised ones and reports every
// access.
class DescriptorPools {
 public:
  explicit DescriptorPools(VkDevice device) : device_(device) {}
  ~DescriptorPools();
  DescriptorPools(const DescriptorPools&) = delete;
  DescriptorPools& operator=(const DescriptorPools&) = delete;

  // Registers the layout of set 0 of a pipeline layout.
  void remember(VkPipelineLayout layout, VkDescriptorSetLayout set) { layouts_[layout] = set; }
  // The sets of a layout or a command buffer, which must not be in use, go back to their pools.
  void forget(VkPipelineLayout layout);
  void forget(VkCommandBuffer cmd);
  void begin(VkCommandBuffer cmd);
  void bind(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout, uint32_t set,
            std::span<const VkWriteDescriptorSet> writes);

 private:
  struct Set {
    VkDescriptorSet handle = VK_NULL_HANDLE;
    VkDescriptorPool pool = VK_NULL_HANDLE;
  };
  struct Ring {
    std::vector<Set> sets;
    size_t used = 0;  // since the command buffer began
  };
  Set allocate(VkDescriptorSetLayout layout);
  void free(const Ring& ring);
  VkDevice device_;
  std::vector<VkDescriptorPool> pools_;
  std::unordered_map<VkPipelineLayout, VkDescriptorSetLayout> layouts_;
  std::unordered_map<VkCommandBuffer, std::unordered_map<VkPipelineLayout, Ring>> rings_;
  std::vector<VkWriteDescriptorSet> writes_;  // of one set
};

}  // namespace fovea::gpu
