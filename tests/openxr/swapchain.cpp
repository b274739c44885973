// Images of the headset, on the device of the application.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "tests/openxr/runtime.h"

namespace fovea::test {
namespace {

constexpr uint32_t kImages = 3;

bool isSwapchain(XrSwapchain swapchain) {
  return runtime().swapchains.contains(reinterpret_cast<Swapchain*>(swapchain));
}
Swapchain& chainOf(XrSwapchain swapchain) { return *reinterpret_cast<Swapchain*>(swapchain); }

uint32_t memoryType(VkPhysicalDevice physical, uint32_t bits, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
    if ((bits >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  return 0;
}

VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
  const SessionState& s = *runtime().session;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = needs.size;
  info.memoryTypeIndex = memoryType(s.physical, needs.memoryTypeBits, wanted);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  vkAllocateMemory(s.device, &info, nullptr, &memory);
  return memory;
}

VkImageMemoryBarrier barrier(VkImage image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  b.srcAccessMask = b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  b.oldLayout = from;
  b.newLayout = to;
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  b.image = image;
  b.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return b;
}

// Records, submits and waits.
template <class Record>
void run(const Record& record) {
  const SessionState& s = *runtime().session;
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = s.queueFamily;
  VkCommandPool pool = VK_NULL_HANDLE;
  vkCreateCommandPool(s.device, &poolInfo, nullptr, &pool);
  VkCommandBufferAllocateInfo allocateInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocateInfo.commandPool = pool;
  allocateInfo.commandBufferCount = 1;
  VkCommandBuffer cmd = VK_NULL_HANDLE;
  vkAllocateCommandBuffers(s.device, &allocateInfo, &cmd);
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  vkBeginCommandBuffer(cmd, &begin);
  record(cmd);
  vkEndCommandBuffer(cmd);
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &cmd;
  vkQueueSubmit(s.queue, 1, &submit, VK_NULL_HANDLE);
  vkQueueWaitIdle(s.queue);
  vkDestroyCommandPool(s.device, pool, nullptr);
}

void change(VkCommandBuffer cmd, const VkImageMemoryBarrier& b) {
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                       nullptr, 0, nullptr, 1, &b);
}

}  // namespace

XrResult enumerateSwapchainFormats(XrSession, uint32_t capacity, uint32_t* count, int64_t* formats) {
  const std::vector<int64_t>& list = runtime().script.formats;
  *count = uint32_t(list.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  std::copy(list.begin(), list.end(), formats);
  return XR_SUCCESS;
}

XrResult createSwapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* swapchain) {
  Runtime& r = runtime();
  const std::vector<int64_t>& list = r.script.formats;
  if (std::find(list.begin(), list.end(), info->format) == list.end())
    return XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED;
  auto* chain = new Swapchain;
  r.swapchains.insert(chain);
  *swapchain = handleOf<XrSwapchain>(chain);
  chain->width = info->width, chain->height = info->height;
  VkImageCreateInfo image{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  image.imageType = VK_IMAGE_TYPE_2D;
  image.format = VkFormat(info->format);
  image.extent = {info->width, info->height, 1};
  image.mipLevels = image.arrayLayers = 1;
  image.samples = VK_SAMPLE_COUNT_1_BIT;
  image.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (info->usageFlags & XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT) image.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (info->usageFlags & XR_SWAPCHAIN_USAGE_SAMPLED_BIT) image.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  for (uint32_t i = 0; i < kImages; ++i) {
    VkImage made = VK_NULL_HANDLE;
    if (vkCreateImage(r.session->device, &image, nullptr, &made) != VK_SUCCESS) return XR_ERROR_OUT_OF_MEMORY;
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(r.session->device, made, &needs);
    chain->images.push_back(made);
    chain->memory.push_back(allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
    vkBindImageMemory(r.session->device, made, chain->memory.back(), 0);
    run([&](VkCommandBuffer cmd) {
      change(cmd, barrier(made, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
    });
  }
  return XR_SUCCESS;
}

void Runtime::destroy(Swapchain& chain) {
  vkQueueWaitIdle(session->queue);
  for (VkImage image : chain.images) vkDestroyImage(session->device, image, nullptr);
  for (VkDeviceMemory memory : chain.memory) vkFreeMemory(session->device, memory, nullptr);
}

XrResult destroySwapchain(XrSwapchain swapchain) {
  if (!isSwapchain(swapchain)) return XR_ERROR_HANDLE_INVALID;
  Swapchain& chain = chainOf(swapchain);
  runtime().destroy(chain);
  runtime().swapchains.erase(&chain);
  delete &chain;
  return XR_SUCCESS;
}

XrResult enumerateSwapchainImages(XrSwapchain swapchain, uint32_t capacity, uint32_t* count,
                                  XrSwapchainImageBaseHeader* images) {
  if (!isSwapchain(swapchain)) return XR_ERROR_HANDLE_INVALID;
  *count = kImages;
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < kImages) return XR_ERROR_SIZE_INSUFFICIENT;
  auto* list = reinterpret_cast<XrSwapchainImageVulkan2KHR*>(images);
  for (uint32_t i = 0; i < kImages; ++i) list[i].image = chainOf(swapchain).images[i];
  return XR_SUCCESS;
}

XrResult acquireSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo*, uint32_t* index) {
  Runtime& r = runtime();
  if (const XrResult failed = r.scripted("xrAcquireSwapchainImage"); failed != XR_SUCCESS) return failed;
  if (!isSwapchain(swapchain)) return XR_ERROR_HANDLE_INVALID;
  Swapchain& chain = chainOf(swapchain);
  if (chain.acquired.size() == kImages) {
    r.violation("more images are taken than there are");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  *index = chain.next;
  chain.next = (chain.next + 1) % kImages;
  chain.acquired.push_back(*index);
  return XR_SUCCESS;
}

XrResult waitSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageWaitInfo*) {
  Runtime& r = runtime();
  if (!isSwapchain(swapchain)) return XR_ERROR_HANDLE_INVALID;
  Swapchain& chain = chainOf(swapchain);
  if (chain.acquired.empty() || chain.waited) {
    r.violation("an image is waited for that was not taken");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  if (const XrResult scripted = r.scripted("xrWaitSwapchainImage"); scripted != XR_SUCCESS) return scripted;
  chain.waited = true;
  return XR_SUCCESS;
}

XrResult releaseSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo*) {
  Runtime& r = runtime();
  if (!isSwapchain(swapchain)) return XR_ERROR_HANDLE_INVALID;
  Swapchain& chain = chainOf(swapchain);
  if (!chain.waited) {
    r.violation("an image is given back that was not waited for");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  chain.released = int(chain.acquired.front());
  chain.acquired.pop_front();
  chain.waited = false;
  return XR_SUCCESS;
}

// A .ppm file: the texels as they are stored, without alpha.
void Runtime::write(const Swapchain& chain, uint64_t frame, size_t view) {
  const VkImage image = chain.images[size_t(chain.released)];
  const size_t texels = size_t(chain.width) * chain.height;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = 4 * texels;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  vkCreateBuffer(session->device, &info, nullptr, &buffer);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(session->device, buffer, &needs);
  const VkDeviceMemory memory =
      allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  vkBindBufferMemory(session->device, buffer, memory, 0);
  run([&](VkCommandBuffer cmd) {
    const VkImageLayout shown = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        read = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    change(cmd, barrier(image, shown, read));
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {chain.width, chain.height, 1};
    vkCmdCopyImageToBuffer(cmd, image, read, buffer, 1, &region);
    change(cmd, barrier(image, read, shown));
    VkMemoryBarrier host{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    host.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    host.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &host, 0,
                         nullptr, 0, nullptr);
  });
  void* mapped = nullptr;
  vkMapMemory(session->device, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
  char name[64];
  std::snprintf(name, sizeof(name), "frame_%05llu_view%zu.ppm", static_cast<unsigned long long>(frame), view);
  std::ofstream file(output / name, std::ios::binary);
  file << "P6\n" << chain.width << " " << chain.height << "\n255\n";
  std::string rgb(3 * texels, '\0');
  for (size_t i = 0; i < texels; ++i) std::memcpy(&rgb[3 * i], static_cast<const char*>(mapped) + 4 * i, 3);
  file << rgb;
  vkDestroyBuffer(session->device, buffer, nullptr);
  vkFreeMemory(session->device, memory, nullptr);
}

}  // namespace fovea::test
