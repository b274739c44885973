// VK_LAYER_FOVEA_commands: a Vulkan layer that counts the commands of frames on a driver that does not execute them. At
// every submit it appends a line of JSON to the file that FOVEA_COMMANDS names: how often each function has been called
// since the submit before. Such drivers report few features and small limits, so the layer raises both.
#include "tests/support/vulkan_layer.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <type_traits>

namespace {

namespace layer = fovea::test::layer;

// clang-format off
#define FOVEA_COUNTED(F) \
  F(vkAllocateDescriptorSets) F(vkAllocateMemory) F(vkCmdBeginRendering) F(vkCmdClearColorImage) \
  F(vkCmdClearDepthStencilImage) F(vkCmdCopyBuffer) F(vkCmdCopyBufferToImage) F(vkCmdCopyImage) \
  F(vkCmdCopyImageToBuffer) F(vkCmdDispatch) F(vkCmdDispatchIndirect) F(vkCmdDraw) F(vkCmdDrawIndexed) \
  F(vkCmdDrawIndirect) F(vkCmdFillBuffer) F(vkCmdPipelineBarrier2) F(vkCmdPushDescriptorSetKHR) \
  F(vkCmdWriteTimestamp2) F(vkCreateComputePipelines) F(vkCreateGraphicsPipelines) F(vkDeviceWaitIdle) \
  F(vkUpdateDescriptorSets) F(vkWaitForFences)
#define FOVEA_REPLACED(F) \
  F(vkGetPhysicalDeviceFeatures2, featuresOf) F(vkGetPhysicalDeviceFormatProperties, formatOf) \
  F(vkGetPhysicalDeviceImageFormatProperties, imageOf) F(vkGetPhysicalDeviceProperties, propertiesOf) \
  F(vkGetPhysicalDeviceProperties2, moreOf)
// clang-format on

std::map<std::string, unsigned> counts;

// ---- Counts ---------------------------------------------------------------------------------------------------------

// One function: that of the next layer, and the one that stands before it.
template <class Pfn>
struct Function;

template <class Result, class... Arguments>
struct Function<Result(VKAPI_PTR*)(Arguments...)> {
  using Pfn = Result(VKAPI_PTR*)(Arguments...);

  template <Function& self>
  static VKAPI_ATTR Result VKAPI_CALL call(Arguments... arguments) {
    ++counts[self.name];
    return self.next(arguments...);
  }

  const char* name;
  Pfn next = nullptr;
};

#define FOVEA_DEFINE(function, ...) Function<PFN_##function> function##_{#function};
FOVEA_COUNTED(FOVEA_DEFINE)
FOVEA_REPLACED(FOVEA_DEFINE)
FOVEA_DEFINE(vkQueueSubmit2)

template <auto& function>
PFN_vkVoidFunction counted(PFN_vkVoidFunction next) {
  using Type = std::remove_reference_t<decltype(function)>;
  function.next = reinterpret_cast<typename Type::Pfn>(next);
  return next ? reinterpret_cast<PFN_vkVoidFunction>(&Type::template call<function>) : nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos,
                                      VkFence fence) {
  static std::FILE* const file = [] {
    const char* name = std::getenv("FOVEA_COMMANDS");
    return name ? std::fopen(name, "w") : nullptr;
  }();
  if (file) {
    const char* before = "{";
    for (const auto& [name, number] : counts) {
      std::fprintf(file, "%s\"%s\": %u", before, name.c_str(), number);
      before = ", ";
    }
    std::fprintf(file, counts.empty() ? "{}\n" : "}\n");
    std::fflush(file);
  }
  counts.clear();
  return vkQueueSubmit2_.next(queue, count, infos, fence);
}

// ---- Features and limits --------------------------------------------------------------------------------------------

// Sets all members of a structure from `first` on, which are flags.
template <class Features>
void enable(void* features, VkBool32 Features::*first) {
  auto* begin = &(static_cast<Features*>(features)->*first);
  std::fill(begin, reinterpret_cast<VkBool32*>(static_cast<Features*>(features) + 1), VK_TRUE);
}

VKAPI_ATTR void VKAPI_CALL featuresOf(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
  vkGetPhysicalDeviceFeatures2_.next(device, features);
  enable(&features->features, &VkPhysicalDeviceFeatures::robustBufferAccess);
  for (auto* next = static_cast<VkBaseOutStructure*>(features->pNext); next; next = next->pNext) {
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES)
      enable(next, &VkPhysicalDeviceVulkan11Features::storageBuffer16BitAccess);
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
      enable(next, &VkPhysicalDeviceVulkan12Features::samplerMirrorClampToEdge);
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
      enable(next, &VkPhysicalDeviceVulkan13Features::robustImageAccess);
  }
}

// Limits that the desktop GPUs of the last years have.
void raise(VkPhysicalDeviceLimits& limits) {
  limits.maxImageDimension1D = limits.maxImageDimension2D = limits.maxImageDimensionCube = 16384;
  limits.maxImageDimension3D = limits.maxImageArrayLayers = 2048;
  limits.maxTexelBufferElements = 1u << 27;
  limits.maxUniformBufferRange = 1u << 16;
  limits.maxStorageBufferRange = 0xffffffffu;
  limits.maxPushConstantsSize = 256;
  limits.maxBoundDescriptorSets = 8;
  limits.maxPerStageDescriptorUniformBuffers = limits.maxPerStageDescriptorStorageBuffers = 1u << 16;
  limits.maxPerStageDescriptorSampledImages = limits.maxPerStageDescriptorStorageImages = 1u << 16;
  limits.maxPerStageResources = 1u << 20;
  limits.maxColorAttachments = limits.maxFragmentOutputAttachments = 8;
  limits.maxComputeSharedMemorySize = 32768;
  limits.maxComputeWorkGroupInvocations = 1024;
  limits.maxComputeWorkGroupSize[0] = limits.maxComputeWorkGroupSize[1] = 1024;
  limits.maxComputeWorkGroupSize[2] = 64;
  limits.maxViewportDimensions[0] = limits.maxViewportDimensions[1] = 16384;
  limits.maxFramebufferWidth = limits.maxFramebufferHeight = 16384;
}

VKAPI_ATTR void VKAPI_CALL propertiesOf(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties) {
  vkGetPhysicalDeviceProperties_.next(device, properties);
  raise(properties->limits);
}

VKAPI_ATTR void VKAPI_CALL moreOf(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
  vkGetPhysicalDeviceProperties2_.next(device, properties);
  raise(properties->properties.limits);
  for (auto* next = static_cast<VkBaseOutStructure*>(properties->pNext); next; next = next->pNext) {
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES) {
      auto* of11 = reinterpret_cast<VkPhysicalDeviceVulkan11Properties*>(next);
      of11->subgroupSize = 32;
      of11->subgroupSupportedStages = VK_SHADER_STAGE_ALL;
      of11->subgroupSupportedOperations = 0xff;
    } else if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES) {
      reinterpret_cast<VkPhysicalDeviceVulkan13Properties*>(next)->maxBufferSize = VkDeviceSize(1) << 32;
    }
  }
}

VKAPI_ATTR void VKAPI_CALL formatOf(VkPhysicalDevice device, VkFormat format,
                                    VkFormatProperties* properties) {
  vkGetPhysicalDeviceFormatProperties_.next(device, format, properties);
  *properties = {~0u, ~0u, ~0u};
}

VKAPI_ATTR VkResult VKAPI_CALL imageOf(VkPhysicalDevice device, VkFormat format, VkImageType type,
                                       VkImageTiling tiling, VkImageUsageFlags usage,
                                       VkImageCreateFlags flags, VkImageFormatProperties* properties) {
  vkGetPhysicalDeviceImageFormatProperties_.next(device, format, type, tiling, usage, flags, properties);
  const uint32_t side = type == VK_IMAGE_TYPE_3D ? 2048 : 16384;
  *properties = {{side, type == VK_IMAGE_TYPE_1D ? 1 : side, type == VK_IMAGE_TYPE_3D ? side : 1},
                 15,
                 type == VK_IMAGE_TYPE_3D ? 1u : 2048u,
                 VK_SAMPLE_COUNT_1_BIT,
                 VkDeviceSize(1) << 40};
  return VK_SUCCESS;
}

template <class Pfn, class Replacement>
PFN_vkVoidFunction replaced(Function<Pfn>& function, PFN_vkVoidFunction next, Replacement* replacement) {
  function.next = reinterpret_cast<Pfn>(next);
  return next ? reinterpret_cast<PFN_vkVoidFunction>(replacement) : nullptr;
}

// ---- The layer ------------------------------------------------------------------------------------------------------

PFN_vkVoidFunction ofDevice(const char* name, PFN_vkVoidFunction next) {
  if (!std::strcmp(name, "vkQueueSubmit2")) return replaced(vkQueueSubmit2_, next, submit);
#define FOVEA_COUNT(function) \
  if (!std::strcmp(name, #function)) return counted<function##_>(next);
  FOVEA_COUNTED(FOVEA_COUNT)
  return next;
}

PFN_vkVoidFunction ofInstance(const char* name, PFN_vkVoidFunction next) {
#define FOVEA_REPLACE(function, replacement) \
  if (!std::strcmp(name, #function)) return replaced(function##_, next, replacement);
  FOVEA_REPLACED(FOVEA_REPLACE)
  return next;
}

}  // namespace

extern "C" VK_LAYER_EXPORT VkResult
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
  return layer::negotiate(interface, {ofInstance, ofDevice});
}
