// Buffers and images that own their memory or are placed into memory of the graph's transient heap.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "framework/gpu/unique.h"

namespace fovea::gpu {

class Device;

// The deleter of memory that a device has allocated.
struct ReleaseMemory {
  using pointer = VkDeviceMemory;
  Device* device = nullptr;
  void operator()(VkDeviceMemory memory) const;
};
using UniqueMemory = std::unique_ptr<std::remove_pointer_t<VkDeviceMemory>, ReleaseMemory>;

enum class MemoryKind { Device, Upload, Readback };  // Upload and Readback are mapped and coherent

struct BufferDesc {
  std::string name;
  uint64_t bytes = 0;
  VkBufferUsageFlags usage = 0;
  MemoryKind memory = MemoryKind::Device;
};

// Move-only; of one that was moved from only the destructor and assignment may be used. Assignment frees the old memory
// before what is bound to it, which Vulkan allows. Throws Error(OutOfMemory) naming the buffer and its size.
class Buffer {
 public:
  Buffer() = default;
  Buffer(Device& device, const BufferDesc& desc);  // owns its memory
  // Placed into memory that it does not own.
  Buffer(Device& device, const BufferDesc& desc, VkDeviceMemory memory, uint64_t offset);

  explicit operator bool() const { return bool(handle_); }
  VkBuffer handle() const { return handle_.get(); }
  uint64_t bytes() const { return desc_.bytes; }
  const std::string& name() const { return desc_.name; }
  void* mapped() const { return mapped_; }  // null unless Upload or Readback, or Device::sharesMemory()
  // Typed view of the whole buffer for uniform or storage texel buffers; created on first use and cached.
  VkBufferView texelView(VkFormat format);

 private:
  void create();
  void bind(VkDeviceMemory memory, uint64_t offset);
  Device* device_ = nullptr;
  BufferDesc desc_;
  UniqueMemory memory_;  // null if it is placed
  UniqueBuffer handle_;
  void* mapped_ = nullptr;
  std::map<VkFormat, UniqueBufferView> views_;
};

struct ImageDesc {
  std::string name;
  VkImageType type = VK_IMAGE_TYPE_2D;
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t width = 1, height = 1, depth = 1, layers = 1, mips = 1;
  bool array = false;  // the default view is an array view even with one layer
  VkImageUsageFlags usage = 0;
  bool linear = false;  // row after row, so that the host finds the texels if it shares the memory
};

// The texels of an image as the host finds them.
struct TexelRows {
  std::byte* first = nullptr;
  uint64_t rowBytes = 0;  // from row to row
};

// Move-only like Buffer; device memory.
class Image {
 public:
  Image() = default;
  Image(Device& device, const ImageDesc& desc);
  Image(Device& device, const ImageDesc& desc, VkDeviceMemory memory, uint64_t offset);

  explicit operator bool() const { return bool(handle_); }
  VkImage handle() const { return handle_.get(); }
  const ImageDesc& desc() const { return desc_; }
  const std::string& name() const { return desc_.name; }
  VkExtent3D extent() const { return {desc_.width, desc_.height, desc_.depth}; }
  VkImageAspectFlags aspect() const;
  const TexelRows& texels() const { return texels_; }  // none unless it is linear and Device::sharesMemory()
  // Views of the whole image, of one mip level (all layers), or of one layer of one mip level. They are created on
  // first use and cached.
  VkImageView view();
  VkImageView mipView(uint32_t mip);
  VkImageView layerView(uint32_t mip, uint32_t layer);

 private:
  VkImageView makeView(uint32_t firstMip, uint32_t mips, uint32_t firstLayer, uint32_t layers, bool array);
  void create();
  void bind(VkDeviceMemory memory, uint64_t offset);
  Device* device_ = nullptr;
  ImageDesc desc_;
  UniqueMemory memory_;  // null if it is placed
  UniqueImage handle_;
  TexelRows texels_;
  std::map<std::tuple<uint32_t, uint32_t, uint32_t, uint32_t, bool>, UniqueImageView> views_;
};

// Whether an image may be linear.
bool supportsLinear(const Device& device, const ImageDesc& desc);

// Memory requirements, determined without creating memory; input to the aliasing phase.
VkMemoryRequirements memoryRequirements(Device& device, const BufferDesc& desc);
VkMemoryRequirements memoryRequirements(Device& device, const ImageDesc& desc);

// Transfers for set-up, which wait for completion. The image is left in `layout`.
void upload(Device& device, Buffer& buffer, std::span<const std::byte> data, uint64_t offset = 0);
void upload(Device& device, Image& image, std::span<const std::byte> texels, VkImageLayout layout);
std::vector<std::byte> download(Device& device, const Buffer& buffer);
// Returns mip 0, tightly packed, layer after layer. The image is in `layout` before and after.
std::vector<std::byte> download(Device& device, const Image& image, VkImageLayout layout);

// Shared samplers: nearest or linear, clamped or repeating.
VkSampler sampler(Device& device, VkFilter filter, VkSamplerAddressMode mode);

}  // namespace fovea::gpu
