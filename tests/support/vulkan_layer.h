// What the Vulkan layers of the tests have in common. A layer serves one instance and one device at a time.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace fovea::test::layer {

inline PFN_vkGetInstanceProcAddr nextOfInstance = nullptr;
inline PFN_vkGetDeviceProcAddr nextOfDevice = nullptr;

// The link to the next layer that the loader puts into the chain of a create info.
template <class Link>
Link* linkIn(const void* chain, VkStructureType type) {
  auto* link = const_cast<Link*>(static_cast<const Link*>(chain));
  while (link && (link->sType != type || link->function != VK_LAYER_LINK_INFO))
    link = const_cast<Link*>(static_cast<const Link*>(link->pNext));
  return link;
}

// Creates an instance by the next layer, and remembers that layer.
inline VkResult createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks,
                               VkInstance* instance) {
  auto* link = linkIn<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  nextOfInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(nextOfInstance(nullptr, "vkCreateInstance"));
  return create(info, callbacks, instance);
}

// The same for a device.
inline VkResult createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                             const VkAllocationCallbacks* callbacks, VkDevice* device) {
  auto* link = linkIn<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  const auto functions = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  nextOfDevice = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(functions(nullptr, "vkCreateDevice"));
  return create(physical, info, callbacks, device);
}

// Tells the loader the functions of a layer.
inline VkResult negotiate(VkNegotiateLayerInterface* interface, PFN_vkGetInstanceProcAddr ofInstance,
                          PFN_vkGetDeviceProcAddr ofDevice) {
  interface->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
  interface->pfnGetInstanceProcAddr = ofInstance;
  interface->pfnGetDeviceProcAddr = ofDevice;
  interface->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}

}  // namespace fovea::test::layer
