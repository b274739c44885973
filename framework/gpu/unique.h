// Vulkan objects that are destroyed with their owner.
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <type_traits>

namespace fovea::gpu {

// The deleter of a handle. kDestroy: the Vulkan function that destroys it, such as vkDestroyBuffer.
template <class Handle, auto kDestroy>
struct Destroy {
  using pointer = Handle;
  VkDevice device = VK_NULL_HANDLE;
  void operator()(Handle handle) const { kDestroy(device, handle, nullptr); }
};

template <class Handle, auto kDestroy>
using Unique = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy<Handle, kDestroy>>;

using UniqueBuffer = Unique<VkBuffer, vkDestroyBuffer>;
using UniqueBufferView = Unique<VkBufferView, vkDestroyBufferView>;
using UniqueImage = Unique<VkImage, vkDestroyImage>;
using UniqueImageView = Unique<VkImageView, vkDestroyImageView>;

}  // namespace fovea::gpu
