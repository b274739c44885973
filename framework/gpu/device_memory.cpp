#include "framework/gpu/device_memory.h"

#include <algorithm>

#include "fovea/error.h"
#include "framework/gpu/device.h"

namespace fovea::gpu {
namespace {

// Memory that the host reaches as fast as any other.
constexpr VkMemoryPropertyFlags kShared = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                          VK_MEMORY_PROPERTY_HOST_COHERENT_BIT |
                                          VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

std::string mebibytes(uint64_t bytes) {
  if (bytes < (1u << 20)) return std::to_string(bytes) + " bytes";
  const uint64_t tenths = (bytes * 10 + (1u << 19)) >> 20;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " MiB";
}

}  // namespace

DeviceMemory::DeviceMemory(VkPhysicalDevice physical, VkDevice device, uint64_t maxAllocation, uint64_t limit,
                           bool addresses)
    : device_(device), maxAllocation_(maxAllocation), limit_(limit), addresses_(addresses) {
  vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

uint32_t DeviceMemory::type(uint32_t bits, VkMemoryPropertyFlags flags) const {
  for (uint32_t i = 0; i < properties_.memoryTypeCount; ++i) {
    if ((bits & (1u << i)) && (properties_.memoryTypes[i].propertyFlags & flags) == flags) return i;
  }
  return ~0u;
}

bool DeviceMemory::isShared(uint32_t type) const {
  return type != ~0u && (properties_.memoryTypes[type].propertyFlags & kShared) == kShared;
}

bool DeviceMemory::isShared() const { return isShared(type(~0u, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)); }

VkDeviceMemory DeviceMemory::allocate(uint64_t bytes, uint32_t memoryTypeBits, VkMemoryPropertyFlags flags,
                                      const std::string& what) {
  const uint32_t index = type(memoryTypeBits, flags);
  if (index == ~0u) throw Error(ExitCode::Internal, "no memory type of this device fits `" + what + "`");
  const uint32_t heap = properties_.memoryTypes[index].heapIndex;
  const std::string remedy = "use a smaller image, or parameters that need less memory" +
                             std::string(limit_ ? ", or raise the memory limit" : "");
  const std::lock_guard lock(mutex_);
  const uint64_t used = limit_ ? allocated_ : heapAllocated_[heap];
  const uint64_t limit = limit_ ? limit_ : properties_.memoryHeaps[heap].size;
  const auto fail = [&](const std::string& why) {
    throw Error(ExitCode::OutOfMemory, "out of memory: `" + what + "` needs " + mebibytes(bytes) + "; " + why,
                remedy);
  };
  if (bytes > limit || used > limit - bytes)
    fail(mebibytes(used) + " of " + mebibytes(limit) + " device memory are in use");
  if (maxAllocation_ && bytes > maxAllocation_)
    fail("this device's maxMemoryAllocationSize is " + mebibytes(maxAllocation_));
  VkMemoryAllocateFlagsInfo flagsInfo{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  if (addresses_) flagsInfo.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flagsInfo};
  info.allocationSize = bytes;
  info.memoryTypeIndex = index;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const VkResult result = vkAllocateMemory(device_, &info, nullptr, &memory);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    fail("the driver has no more (" + mebibytes(used) + " are in use)");
  check(result, "allocating " + mebibytes(bytes) + " for `" + what + "`");
  void* address = nullptr;
  if (isShared(index)) {
    const VkResult mapped = vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &address);
    if (mapped != VK_SUCCESS) vkFreeMemory(device_, memory, nullptr);
    check(mapped, "mapping `" + what + "`");
  }
  allocations_.emplace(memory, Allocation{heap, bytes, address});
  heapAllocated_[heap] += bytes;
  allocated_ += bytes;
  peak_ = std::max(peak_, allocated_);
  return memory;
}

void DeviceMemory::release(VkDeviceMemory memory) {
  if (!memory) return;
  const std::lock_guard lock(mutex_);
  if (const auto it = allocations_.find(memory); it != allocations_.end()) {
    heapAllocated_[it->second.heap] -= it->second.bytes;
    allocated_ -= it->second.bytes;
    allocations_.erase(it);
  }
  vkFreeMemory(device_, memory, nullptr);
}

void* DeviceMemory::mapped(VkDeviceMemory memory) const {
  const std::lock_guard lock(mutex_);
  const auto it = allocations_.find(memory);
  return it == allocations_.end() ? nullptr : it->second.address;
}

uint64_t DeviceMemory::allocatedBytes() const {
  const std::lock_guard lock(mutex_);
  return allocated_;
}

uint64_t DeviceMemory::peakBytes() const {
  const std::lock_guard lock(mutex_);
  return peak_;
}

}  // namespace fovea::gpu
