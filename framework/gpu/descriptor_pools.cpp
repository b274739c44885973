#include "framework/gpu/descriptor_pools.h"

#include "framework/gpu/device.h"

namespace fovea::gpu {

DescriptorPools::~DescriptorPools() {
  for (const VkDescriptorPool pool : pools_) vkDestroyDescriptorPool(device_, pool, nullptr);
}

VkDescriptorSet DescriptorPools::allocate(VkDescriptorSetLayout layout) {
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (!pools_.empty()) {
    info.descriptorPool = pools_.back();
    if (vkAllocateDescriptorSets(device_, &info, &set) == VK_SUCCESS) return set;
  }
  constexpr uint32_t kSets = 256;
  std::vector<VkDescriptorPoolSize> sizes;
  for (int type = VK_DESCRIPTOR_TYPE_SAMPLER; type <= VK_DESCRIPTOR_TYPE_STORAGE_BUFFER; ++type)
    sizes.push_back({VkDescriptorType(type), kSets * 8});
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.maxSets = kSets;
  pool.poolSizeCount = uint32_t(sizes.size());
  pool.pPoolSizes = sizes.data();
  check(vkCreateDescriptorPool(device_, &pool, nullptr, &pools_.emplace_back()),
        "creating a descriptor pool");
  info.descriptorPool = pools_.back();
  check(vkAllocateDescriptorSets(device_, &info, &set), "allocating a descriptor set");
  return set;
}

void DescriptorPools::bind(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                           uint32_t set, std::vector<VkWriteDescriptorSet> writes) {
  const VkDescriptorSet handle = allocate(layouts_.at(layout));
  for (VkWriteDescriptorSet& write : writes) write.dstSet = handle;
  vkUpdateDescriptorSets(device_, uint32_t(writes.size()), writes.data(), 0, nullptr);
  vkCmdBindDescriptorSets(cmd, point, layout, set, 1, &handle, 0, nullptr);
}

}  // namespace fovea::gpu
