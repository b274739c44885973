// VK_LAYER_FOVEA_faults: a Vulkan layer that makes functions fail (fault.h). It intercepts the functions that return a
// result and that the framework calls. Their calls are listed in the file that FOVEA_CALLS names, one per line. It
// serves one instance and one device at a time, from one thread.
#include "tests/support/vulkan_layer.h"

#include <cstdio>
#include <cstring>

#include "fault.h"

namespace {

namespace layer = fovea::test::layer;

// clang-format off
#define FOVEA_INSTANCE_FUNCTIONS(F) \
  F(vkCreateDebugUtilsMessengerEXT) F(vkEnumerateDeviceExtensionProperties) F(vkEnumeratePhysicalDevices) \
  F(vkGetPhysicalDeviceImageFormatProperties)

#define FOVEA_DEVICE_FUNCTIONS(F) \
  F(vkAllocateCommandBuffers) F(vkAllocateDescriptorSets) F(vkAllocateMemory) F(vkBeginCommandBuffer) \
  F(vkBindBufferMemory) F(vkBindImageMemory) F(vkCreateBuffer) F(vkCreateBufferView) F(vkCreateCommandPool) \
  F(vkCreateComputePipelines) F(vkCreateDescriptorPool) F(vkCreateDescriptorSetLayout) F(vkCreateFence) \
  F(vkCreateGraphicsPipelines) F(vkCreateImage) F(vkCreateImageView) F(vkCreatePipelineCache) \
  F(vkCreatePipelineLayout) F(vkCreateQueryPool) F(vkCreateSampler) F(vkCreateShaderModule) \
  F(vkDeviceWaitIdle) F(vkEndCommandBuffer) F(vkGetFenceStatus) F(vkGetPipelineCacheData) \
  F(vkGetQueryPoolResults) F(vkMapMemory) F(vkQueueSubmit2) F(vkResetCommandPool) F(vkResetFences) \
  F(vkSetDebugUtilsObjectNameEXT) F(vkWaitForFences)
// clang-format on

// The result of a call that fails; notes the call.
std::optional<VkResult> fault(Fault& fault, const char* function) {
  static std::FILE* const calls = [] {
    const char* name = std::getenv("FOVEA_CALLS");
    return name ? std::fopen(name, "w") : nullptr;
  }();
  if (calls) std::fprintf(calls, "%s\n", function);
  const auto result = fault.next();
  return result ? std::optional(static_cast<VkResult>(*result)) : std::nullopt;
}

// One function: that of the next layer, and the one that stands before it.
template <class Pfn>
struct Function;

template <class... Arguments>
struct Function<VkResult(VKAPI_PTR*)(Arguments...)> {
  using Pfn = VkResult(VKAPI_PTR*)(Arguments...);

  template <Function& self>
  static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
    if (const auto result = fault(self.faults, self.name)) return *result;
    return self.next(arguments...);
  }

  const char* name;
  Fault faults{name};
  Pfn next = nullptr;
};

#define FOVEA_DEFINE(function) Function<PFN_##function> function##_{#function};
FOVEA_INSTANCE_FUNCTIONS(FOVEA_DEFINE)
FOVEA_DEVICE_FUNCTIONS(FOVEA_DEFINE)
FOVEA_DEFINE(vkCreateInstance)
FOVEA_DEFINE(vkCreateDevice)

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* callbacks, VkInstance* instance) {
  if (const auto result = fault(vkCreateInstance_.faults, "vkCreateInstance")) return *result;
  return layer::createInstance(info, callbacks, instance);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
  if (const auto result = fault(vkCreateDevice_.faults, "vkCreateDevice")) return *result;
  return layer::createDevice(physical, info, callbacks, device);
}

template <auto& function>
PFN_vkVoidFunction between(PFN_vkVoidFunction next) {
  using Type = std::remove_reference_t<decltype(function)>;
  function.next = reinterpret_cast<typename Type::Pfn>(next);
  return next ? reinterpret_cast<PFN_vkVoidFunction>(&Type::template call<function>) : nullptr;
}

#define FOVEA_BETWEEN(function) \
  if (!std::strcmp(name, #function)) return between<function##_>(next);

PFN_vkVoidFunction ofDevice(const char* name, PFN_vkVoidFunction next) {
  FOVEA_DEVICE_FUNCTIONS(FOVEA_BETWEEN)
  return next;
}

PFN_vkVoidFunction ofInstance(const char* name, PFN_vkVoidFunction next) {
  FOVEA_INSTANCE_FUNCTIONS(FOVEA_BETWEEN)
  return next;
}

}  // namespace

extern "C" VK_LAYER_EXPORT VkResult
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
  return layer::negotiate(interface, {ofInstance, ofDevice, createInstance, createDevice});
}
