#include "framework/gpu/resources.h"

#include <algorithm>
#include <utility>

#include "fovea/error.h"
#include "framework/gpu/device.h"
#include "framework/gpu/format.h"

namespace fovea::gpu {
namespace {

VkBufferCreateInfo bufferInfo(const BufferDesc& desc) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = desc.bytes;
  info.usage = desc.usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  return info;
}

VkImageCreateInfo imageInfo(const ImageDesc& desc) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = desc.type;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, desc.depth};
  info.mipLevels = desc.mips;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage;
  return info;
}

void checkDesc(Device& device, const BufferDesc& desc) {
  if (desc.bytes == 0) throw Error(ExitCode::Internal, "buffer `" + desc.name + "` has no size");
  if (desc.bytes > device.maxBufferBytes()) {
    throw Error(ExitCode::OutOfMemory,
                "buffer `" + desc.name + "`: " + std::to_string(desc.bytes) +
                    " bytes exceed this device's maxBufferSize " + std::to_string(device.maxBufferBytes()),
                "use fewer elements");
  }
}

void checkLimit(const ImageDesc& desc, const char* what, uint32_t value, const char* limitName,
                uint32_t limit) {
  if (value == 0) throw Error(ExitCode::Internal, "image `" + desc.name + "` has a " + what + " of 0");
  if (value <= limit) return;
  throw Error(ExitCode::BadInput,
              "image `" + desc.name + "`: its " + what + " of " + std::to_string(value) +
                  " exceeds this device's limit of " + std::to_string(limit) + " (" + limitName + ")",
              std::string("choose a smaller ") + what);
}

void checkDesc(Device& device, const ImageDesc& desc) {
  const VkPhysicalDeviceLimits& limits = device.limits();
  const bool volume = desc.type == VK_IMAGE_TYPE_3D;
  const uint32_t side = volume                          ? limits.maxImageDimension3D
                        : desc.type == VK_IMAGE_TYPE_1D ? limits.maxImageDimension1D
                                                        : limits.maxImageDimension2D;
  const char* sideName = volume                          ? "maxImageDimension3D"
                         : desc.type == VK_IMAGE_TYPE_1D ? "maxImageDimension1D"
                                                         : "maxImageDimension2D";
  checkLimit(desc, "width", desc.width, sideName, side);
  checkLimit(desc, "height", desc.height, sideName, side);
  checkLimit(desc, "depth", desc.depth, sideName, volume ? side : 1);
  checkLimit(desc, "layer count", desc.layers, volume ? "a volume has no layers" : "maxImageArrayLayers",
             volume ? 1 : limits.maxImageArrayLayers);
  uint32_t levels = 1;
  for (uint32_t s = std::max({desc.width, desc.height, desc.depth}); s > 1; s /= 2) ++levels;
  checkLimit(desc, "mip count", desc.mips, "its size", levels);

  const VkImageCreateInfo info = imageInfo(desc);
  VkImageFormatProperties properties;
  const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
      device.physical(), info.format, info.imageType, info.tiling, info.usage, info.flags, &properties);
  if (result == VK_ERROR_FORMAT_NOT_SUPPORTED) {
    throw Error(ExitCode::NoDevice,
                "image `" + desc.name + "`: this device cannot use the format " +
                    std::string(formatInfo(desc.format).name) + " in this way (usage bits " +
                    std::to_string(desc.usage) + ")",
                "choose another format or another device");
  }
  check(result, "querying the format of image `" + desc.name + "`");
}

VkMemoryPropertyFlags memoryFlags(MemoryKind kind) {
  switch (kind) {
    case MemoryKind::Device:
      return VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    case MemoryKind::Upload:
    case MemoryKind::Readback:
      return VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  }
  return 0;
}

// Uncached memory is slow to read. Every desktop driver offers memory that is cached and
// coherent, but none is guaranteed.
VkDeviceMemory allocateFor(Device& device, MemoryKind kind, const VkMemoryRequirements& needs,
                           const std::string& what) {
  if (kind == MemoryKind::Readback) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
    const VkMemoryPropertyFlags cached = memoryFlags(kind) | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      if ((needs.memoryTypeBits & (1u << i)) && (memory.memoryTypes[i].propertyFlags & cached) == cached)
        return device.allocate(needs.size, needs.memoryTypeBits, cached, what);
    }
  }
  return device.allocate(needs.size, needs.memoryTypeBits, memoryFlags(kind), what);
}

}  // namespace

// ---- Buffer
// ----------------------------------------------------------------------------------------------------

Buffer::Buffer(Device& device, const BufferDesc& desc) : device_(&device), desc_(desc), owned_(true) {
  checkDesc(device, desc);
  try {
    const VkBufferCreateInfo info = bufferInfo(desc);
    check(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "creating buffer `" + desc.name + "`");
    device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(handle_), desc.name);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), handle_, &needs);
    memory_ = allocateFor(device, desc.memory, needs, desc.name);
    memoryBytes_ = needs.size;
    check(vkBindBufferMemory(device.handle(), handle_, memory_, 0), "binding buffer `" + desc.name + "`");
    if (desc.memory != MemoryKind::Device) {
      check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_),
            "mapping buffer `" + desc.name + "`");
    }
  } catch (...) {
    destroy();
    throw;
  }
}

Buffer::Buffer(Device& device, const BufferDesc& desc, VkDeviceMemory memory, uint64_t offset)
    : device_(&device), desc_(desc), memory_(memory) {
  checkDesc(device, desc);
  try {
    const VkBufferCreateInfo info = bufferInfo(desc);
    check(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "creating buffer `" + desc.name + "`");
    device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(handle_), desc.name);
    check(vkBindBufferMemory(device.handle(), handle_, memory, offset), "placing buffer `" + desc.name + "`");
  } catch (...) {
    destroy();
    throw;
  }
}

Buffer::~Buffer() { destroy(); }

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  device_ = std::exchange(other.device_, nullptr);
  desc_ = std::move(other.desc_);
  handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  memoryBytes_ = std::exchange(other.memoryBytes_, 0);
  owned_ = std::exchange(other.owned_, false);
  mapped_ = std::exchange(other.mapped_, nullptr);
  views_ = std::exchange(other.views_, {});
  return *this;
}

void Buffer::destroy() {
  if (!device_) return;
  for (const auto& [format, view] : views_) vkDestroyBufferView(device_->handle(), view, nullptr);
  views_.clear();
  vkDestroyBuffer(device_->handle(), handle_, nullptr);
  if (owned_) device_->release(memory_, memoryBytes_);
  handle_ = VK_NULL_HANDLE;
  memory_ = VK_NULL_HANDLE;
  mapped_ = nullptr;
  device_ = nullptr;
}

VkBufferView Buffer::texelView(VkFormat format) {
  if (const auto it = views_.find(format); it != views_.end()) return it->second;
  const uint64_t texels = desc_.bytes / formatInfo(format).bytesPerTexel;
  if (texels > device_->limits().maxTexelBufferElements) {
    throw Error(ExitCode::BadInput,
                "buffer `" + desc_.name + "`: " + std::to_string(texels) +
                    " texels exceed this device's maxTexelBufferElements " +
                    std::to_string(device_->limits().maxTexelBufferElements),
                "use fewer elements");
  }
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = handle_;
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view = VK_NULL_HANDLE;
  check(vkCreateBufferView(device_->handle(), &info, nullptr, &view),
        "creating a view of buffer `" + desc_.name + "`");
  device_->setName(VK_OBJECT_TYPE_BUFFER_VIEW, reinterpret_cast<uint64_t>(view), desc_.name);
  views_.emplace(format, view);
  return view;
}

// ---- Image
// -----------------------------------------------------------------------------------------------------

Image::Image(Device& device, const ImageDesc& desc) : device_(&device), desc_(desc), owned_(true) {
  checkDesc(device, desc);
  try {
    const VkImageCreateInfo info = imageInfo(desc);
    check(vkCreateImage(device.handle(), &info, nullptr, &handle_), "creating image `" + desc.name + "`");
    device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(handle_), desc.name);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device.handle(), handle_, &needs);
    memory_ = allocateFor(device, MemoryKind::Device, needs, desc.name);
    memoryBytes_ = needs.size;
    check(vkBindImageMemory(device.handle(), handle_, memory_, 0), "binding image `" + desc.name + "`");
  } catch (...) {
    destroy();
    throw;
  }
}

Image::Image(Device& device, const ImageDesc& desc, VkDeviceMemory memory, uint64_t offset)
    : device_(&device), desc_(desc), memory_(memory) {
  checkDesc(device, desc);
  try {
    const VkImageCreateInfo info = imageInfo(desc);
    check(vkCreateImage(device.handle(), &info, nullptr, &handle_), "creating image `" + desc.name + "`");
    device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(handle_), desc.name);
    check(vkBindImageMemory(device.handle(), handle_, memory, offset), "placing image `" + desc.name + "`");
  } catch (...) {
    destroy();
    throw;
  }
}

Image::~Image() { destroy(); }

Image::Image(Image&& other) noexcept { *this = std::move(other); }

Image& Image::operator=(Image&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  device_ = std::exchange(other.device_, nullptr);
  desc_ = std::move(other.desc_);
  handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  memoryBytes_ = std::exchange(other.memoryBytes_, 0);
  owned_ = std::exchange(other.owned_, false);
  views_ = std::exchange(other.views_, {});
  return *this;
}

void Image::destroy() {
  if (!device_) return;
  for (const auto& [key, view] : views_) vkDestroyImageView(device_->handle(), view, nullptr);
  views_.clear();
  vkDestroyImage(device_->handle(), handle_, nullptr);
  if (owned_) device_->release(memory_, memoryBytes_);
  handle_ = VK_NULL_HANDLE;
  memory_ = VK_NULL_HANDLE;
  device_ = nullptr;
}

VkImageAspectFlags Image::aspect() const {
  return formatInfo(desc_.format).depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageView Image::view() {
  return makeView(0, desc_.mips, 0, desc_.layers, desc_.array || desc_.layers > 1);
}

VkImageView Image::mipView(uint32_t mip) {
  return makeView(mip, 1, 0, desc_.layers, desc_.array || desc_.layers > 1);
}

VkImageView Image::layerView(uint32_t mip, uint32_t layer) { return makeView(mip, 1, layer, 1, false); }

VkImageView Image::makeView(uint32_t firstMip, uint32_t mips, uint32_t firstLayer, uint32_t layers,
                            bool array) {
  if (firstMip + mips > desc_.mips || firstLayer + layers > desc_.layers) {
    throw Error(ExitCode::Internal, "image `" + desc_.name + "` has no mip " + std::to_string(firstMip) +
                                        " of layer " + std::to_string(firstLayer));
  }
  VkImageView& view = views_[{firstMip, mips, firstLayer, layers, array}];
  if (view) return view;
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = handle_;
  switch (desc_.type) {
    case VK_IMAGE_TYPE_1D:
      info.viewType = array ? VK_IMAGE_VIEW_TYPE_1D_ARRAY : VK_IMAGE_VIEW_TYPE_1D;
      break;
    case VK_IMAGE_TYPE_3D:
      info.viewType = VK_IMAGE_VIEW_TYPE_3D;
      break;
    default:
      info.viewType = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  }
  info.format = desc_.format;
  info.subresourceRange = {aspect(), firstMip, mips, firstLayer, layers};
  check(vkCreateImageView(device_->handle(), &info, nullptr, &view),
        "creating a view of image `" + desc_.name + "`");
  device_->setName(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<uint64_t>(view), desc_.name);
  return view;
}

// ---- Requirements, samplers
// ------------------------------------------------------------------------------------

VkMemoryRequirements memoryRequirements(Device& device, const BufferDesc& desc) {
  checkDesc(device, desc);
  const VkBufferCreateInfo create = bufferInfo(desc);
  VkDeviceBufferMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
  info.pCreateInfo = &create;
  VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
  vkGetDeviceBufferMemoryRequirements(device.handle(), &info, &needs);
  return needs.memoryRequirements;
}

VkMemoryRequirements memoryRequirements(Device& device, const ImageDesc& desc) {
  checkDesc(device, desc);
  const VkImageCreateInfo create = imageInfo(desc);
  VkDeviceImageMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS};
  info.pCreateInfo = &create;
  VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
  vkGetDeviceImageMemoryRequirements(device.handle(), &info, &needs);
  return needs.memoryRequirements;
}

VkSampler sampler(Device& device, VkFilter filter, VkSamplerAddressMode mode) {
  return device.sampler(filter, mode);
}

}  // namespace fovea::gpu
