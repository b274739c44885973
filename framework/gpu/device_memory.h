#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>

namespace fovea::gpu {

// The memory of a device, counted in bytes. May be used by several threads at once.
class DeviceMemory {
 public:
  // limit: of the bytes that are allocated at a time; 0 for the size of each heap. addresses: whether
  // Vulkan may be asked for the addresses of buffers in this memory.
  DeviceMemory(VkPhysicalDevice physical, VkDevice device, uint64_t maxAllocation, uint64_t limit,
               bool addresses);

  // what: names the resource in messages. Throws OutOfMemory.
  VkDeviceMemory allocate(uint64_t bytes, uint32_t memoryTypeBits, VkMemoryPropertyFlags flags,
                          const std::string& what);
  void release(VkDeviceMemory memory);
  // Whether the host reaches the device's own memory as it does any other, so that nothing needs a copy.
  bool isShared() const;
  // Where the host finds memory that was allocated; null unless it is such memory.
  void* mapped(VkDeviceMemory memory) const;
  uint64_t allocatedBytes() const;
  uint64_t peakBytes() const;
  uint64_t limit() const { return limit_; }  // 0 if there is none but the heaps

 private:
  struct Allocation {
    uint32_t heap = 0;
    uint64_t bytes = 0;
    void* address = nullptr;  // for the host; null if it is not mapped
  };

  uint32_t type(uint32_t bits, VkMemoryPropertyFlags flags) const;  // ~0u if there is none
  bool isShared(uint32_t type) const;

  VkDevice device_;
  VkPhysicalDeviceMemoryProperties properties_{};
  uint64_t maxAllocation_, limit_;
  bool addresses_;
  mutable std::mutex mutex_;
  uint64_t allocated_ = 0, peak_ = 0;
  uint64_t heapAllocated_[VK_MAX_MEMORY_HEAPS] = {};
  std::unordered_map<VkDeviceMemory, Allocation> allocations_;
};

}  // namespace fovea::gpu
