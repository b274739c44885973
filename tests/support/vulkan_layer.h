// What the Vulkan layers of the tests have in common. A layer serves one instance and one device at a time. It says which
// functions it stands before, and exports vkNegotiateLoaderLayerInterfaceVersion(), which calls negotiate().
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstring>

namespace fovea::test::layer {

inline PFN_vkGetInstanceProcAddr nextOfInstance = nullptr;
inline PFN_vkGetDeviceProcAddr nextOfDevice = nullptr;

// Finds the link to the next layer, which the loader puts into the chain of a create info.
template <class Link>
Link* linkIn(const void* chain, VkStructureType type) {
  auto* link = const_cast<Link*>(static_cast<const Link*>(chain));
  while (link && (link->sType != type || link->function != VK_LAYER_LINK_INFO))
    link = const_cast<Link*>(static_cast<const Link*>(link->pNext));
  return link;
}

// Creates an instance by the next layer, and remembers that layer.
inline VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                                     const VkAllocationCallbacks* callbacks,
                                                     VkInstance* instance) {
  auto* link = linkIn<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  nextOfInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(nextOfInstance(nullptr, "vkCreateInstance"));
  return create(info, callbacks, instance);
}

// Creates a device by the next layer, and remembers that layer.
inline VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                                   const VkAllocationCallbacks* callbacks, VkDevice* device) {
  auto* link = linkIn<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  const auto functions = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  nextOfDevice = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(functions(nullptr, "vkCreateDevice"));
  return create(physical, info, callbacks, device);
}

// Returns the function that a layer puts before `next`, which is the next layer's function of this name. That is `next`
// itself if the layer has none for this name, and null if `next` is null.
using Between = PFN_vkVoidFunction (*)(const char* name, PFN_vkVoidFunction next);

struct Layer {
  Between ofInstance, ofDevice;  // for functions of instances and of devices
  PFN_vkCreateInstance createInstance = layer::createInstance;
  PFN_vkCreateDevice createDevice = layer::createDevice;
};

inline Layer own{};

inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL functionOfDevice(VkDevice device, const char* name) {
  if (!std::strcmp(name, "vkGetDeviceProcAddr"))
    return reinterpret_cast<PFN_vkVoidFunction>(&functionOfDevice);
  return own.ofDevice(name, nextOfDevice(device, name));
}

inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL functionOfInstance(VkInstance instance, const char* name) {
  if (!std::strcmp(name, "vkGetInstanceProcAddr"))
    return reinterpret_cast<PFN_vkVoidFunction>(&functionOfInstance);
  if (!std::strcmp(name, "vkGetDeviceProcAddr"))
    return reinterpret_cast<PFN_vkVoidFunction>(&functionOfDevice);
  if (!std::strcmp(name, "vkCreateInstance")) return reinterpret_cast<PFN_vkVoidFunction>(own.createInstance);
  if (!std::strcmp(name, "vkCreateDevice")) return reinterpret_cast<PFN_vkVoidFunction>(own.createDevice);
  return own.ofInstance(name, nextOfInstance ? nextOfInstance(instance, name) : nullptr);
}

// Tells the loader the functions of a layer.
inline VkResult negotiate(VkNegotiateLayerInterface* interface, const Layer& layer) {
  own = layer;
  interface->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
  interface->pfnGetInstanceProcAddr = functionOfInstance;
  interface->pfnGetDeviceProcAddr = functionOfDevice;
  interface->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}

}  // namespace fovea::test::layer
