#include "framework/gpu/resources.h"

#include <algorithm>

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
  info.tiling = desc.linear ? VK_IMAGE_TILING_LINEAR : VK_IMAGE_TILING_OPTIMAL;
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
UniqueMemory allocateFor(Device& device, MemoryKind kind, const VkMemoryRequirements& needs,
                         const std::string& what) {
  const auto allocated = [&](VkMemoryPropertyFlags flags) {
    return UniqueMemory(device.allocate(needs.size, needs.memoryTypeBits, flags, what), {&device});
  };
  if (kind == MemoryKind::Readback) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
    const VkMemoryPropertyFlags cached = memoryFlags(kind) | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      if ((needs.memoryTypeBits & (1u << i)) && (memory.memoryTypes[i].propertyFlags & cached) == cached)
        return allocated(cached);
    }
  }
  return allocated(memoryFlags(kind));
}

}  // namespace

void ReleaseMemory::operator()(VkDeviceMemory memory) const { device->release(memory); }

// ---- Buffer --------------------------------------------------------------------------------------------------

Buffer::Buffer(Device& device, const BufferDesc& desc) : device_(&device), desc_(desc) {
  create();
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device.handle(), handle(), &needs);
  memory_ = allocateFor(device, desc.memory, needs, desc.name);
  bind(memory_.get(), 0);
  if (!mapped_ && desc.memory != MemoryKind::Device)
    check(vkMapMemory(device.handle(), memory_.get(), 0, VK_WHOLE_SIZE, 0, &mapped_),
          "mapping buffer `" + desc.name + "`");
}

Buffer::Buffer(Device& device, const BufferDesc& desc, VkDeviceMemory memory, uint64_t offset)
    : device_(&device), desc_(desc) {
  create();
  bind(memory, offset);
}

void Buffer::create() {
  checkDesc(*device_, desc_);
  const VkBufferCreateInfo info = bufferInfo(desc_);
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(device_->handle(), &info, nullptr, &buffer), "creating buffer `" + desc_.name + "`");
  handle_ = UniqueBuffer(buffer, {device_->handle()});
  device_->setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer), desc_.name);
}

void Buffer::bind(VkDeviceMemory memory, uint64_t offset) {
  check(vkBindBufferMemory(device_->handle(), handle(), memory, offset),
        "binding buffer `" + desc_.name + "`");
  if (auto* address = static_cast<std::byte*>(device_->mapped(memory))) mapped_ = address + offset;
}

VkBufferView Buffer::texelView(VkFormat format) {
  if (const auto it = views_.find(format); it != views_.end()) return it->second.get();
  const uint64_t texels = desc_.bytes / formatInfo(format).bytesPerTexel;
  if (texels > device_->limits().maxTexelBufferElements) {
    throw Error(ExitCode::BadInput,
                "buffer `" + desc_.name + "`: " + std::to_string(texels) +
                    " texels exceed this device's maxTexelBufferElements " +
                    std::to_string(device_->limits().maxTexelBufferElements),
                "use fewer elements");
  }
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = handle();
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view = VK_NULL_HANDLE;
  check(vkCreateBufferView(device_->handle(), &info, nullptr, &view),
        "creating a view of buffer `" + desc_.name + "`");
  device_->setName(VK_OBJECT_TYPE_BUFFER_VIEW, reinterpret_cast<uint64_t>(view), desc_.name);
  views_.emplace(format, UniqueBufferView(view, {device_->handle()}));
  return view;
}

// ---- Image ---------------------------------------------------------------------------------------------------

Image::Image(Device& device, const ImageDesc& desc) : device_(&device), desc_(desc) {
  create();
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), handle(), &needs);
  memory_ = allocateFor(device, MemoryKind::Device, needs, desc.name);
  bind(memory_.get(), 0);
}

Image::Image(Device& device, const ImageDesc& desc, VkDeviceMemory memory, uint64_t offset)
    : device_(&device), desc_(desc) {
  create();
  bind(memory, offset);
}

void Image::create() {
  checkDesc(*device_, desc_);
  const VkImageCreateInfo info = imageInfo(desc_);
  VkImage image = VK_NULL_HANDLE;
  check(vkCreateImage(device_->handle(), &info, nullptr, &image), "creating image `" + desc_.name + "`");
  handle_ = UniqueImage(image, {device_->handle()});
  device_->setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image), desc_.name);
}

void Image::bind(VkDeviceMemory memory, uint64_t offset) {
  check(vkBindImageMemory(device_->handle(), handle(), memory, offset), "binding image `" + desc_.name + "`");
  auto* address = static_cast<std::byte*>(device_->mapped(memory));
  if (!desc_.linear || !address) return;
  const VkImageSubresource first{aspect(), 0, 0};
  VkSubresourceLayout layout{};
  vkGetImageSubresourceLayout(device_->handle(), handle(), &first, &layout);
  texels_ = {address + offset + layout.offset, layout.rowPitch};
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
  UniqueImageView& known = views_[{firstMip, mips, firstLayer, layers, array}];
  if (known) return known.get();
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = handle();
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
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(device_->handle(), &info, nullptr, &view),
        "creating a view of image `" + desc_.name + "`");
  known = UniqueImageView(view, {device_->handle()});
  device_->setName(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<uint64_t>(view), desc_.name);
  return view;
}

// ---- Requirements, samplers ----------------------------------------------------------------------------------

bool supportsLinear(const Device& device, const ImageDesc& desc) {
  ImageDesc linear = desc;
  linear.linear = true;
  const VkImageCreateInfo info = imageInfo(linear);
  VkImageFormatProperties properties;
  const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
      device.physical(), info.format, info.imageType, info.tiling, info.usage, info.flags, &properties);
  if (result == VK_ERROR_FORMAT_NOT_SUPPORTED) return false;
  check(result, "querying the format of image `" + desc.name + "`");
  return desc.width <= properties.maxExtent.width && desc.height <= properties.maxExtent.height &&
         desc.mips <= properties.maxMipLevels && desc.layers <= properties.maxArrayLayers;
}

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
