#include "framework/gpu/descriptor_pools.h"

#include "framework/gpu/device.h"

namespace fovea::gpu {

DescriptorPools::~DescriptorPools() {
  for (const VkDescriptorPool pool : pools_) vkDestroyDescriptorPool(device_, pool, nullptr);
}

DescriptorPools::Set DescriptorPools::allocate(VkDescriptorSetLayout layout) {
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  for (const VkDescriptorPool pool : pools_) {
    info.descriptorPool = pool;
    if (vkAllocateDescriptorSets(device_, &info, &set) == VK_SUCCESS) return {set, pool};
  }
  constexpr uint32_t kSets = 256;
  std::vector<VkDescriptorPoolSize> sizes;
  for (int type = VK_DESCRIPTOR_TYPE_SAMPLER; type <= VK_DESCRIPTOR_TYPE_STORAGE_BUFFER; ++type)
    sizes.push_back({VkDescriptorType(type), kSets * 8});
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  pool.maxSets = kSets;
  pool.poolSizeCount = uint32_t(sizes.size());
  pool.pPoolSizes = sizes.data();
  check(vkCreateDescriptorPool(device_, &pool, nullptr, &pools_.emplace_back()),
        "creating a descriptor pool");
  info.descriptorPool = pools_.back();
  check(vkAllocateDescriptorSets(device_, &info, &set), "allocating a descriptor set");
  return {set, pools_.back()};
}

void DescriptorPools::free(const Ring& ring) {
  for (const Set& set : ring.sets) vkFreeDescriptorSets(device_, set.pool, 1, &set.handle);
}

void DescriptorPools::forget(VkPipelineLayout layout) {
  layouts_.erase(layout);
  for (auto& [cmd, rings] : rings_) {
    const auto found = rings.find(layout);
    if (found == rings.end()) continue;
    free(found->second);
    rings.erase(found);
  }
}

void DescriptorPools::forget(VkCommandBuffer cmd) {
  const auto found = rings_.find(cmd);
  if (found == rings_.end()) return;
  for (const auto& [layout, ring] : found->second) free(ring);
  rings_.erase(found);
}

void DescriptorPools::begin(VkCommandBuffer cmd) {
  for (auto& [layout, ring] : rings_[cmd]) ring.used = 0;
}

void DescriptorPools::bind(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                           uint32_t set, std::span<const VkWriteDescriptorSet> writes) {
  Ring& ring = rings_[cmd][layout];
  if (ring.used == ring.sets.size()) ring.sets.push_back(allocate(layouts_.at(layout)));
  const VkDescriptorSet handle = ring.sets[ring.used++].handle;
  writes_.assign(writes.begin(), writes.end());
  for (VkWriteDescriptorSet& write : writes_) write.dstSet = handle;
  vkUpdateDescriptorSets(device_, uint32_t(writes_.size()), writes_.data(), 0, nullptr);
  vkCmdBindDescriptorSets(cmd, point, layout, set, 1, &handle, 0, nullptr);
}

}  // namespace fovea::gpu
