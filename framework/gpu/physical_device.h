// Instance and physical devices: what there is, what each lacks, which one to take.
#pragma once

#include <vulkan/vulkan.h>

#include <string>
#include <utility>
#include <vector>

#include "framework/gpu/device.h"

namespace fovea::gpu {

// Vulkan 1.0 to 1.3 features as one pNext chain. Not copyable: it points into itself.
struct FeatureChain {
  FeatureChain();
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan13Features v13{};

  using List = std::vector<std::pair<const char*, VkBool32*>>;
  List required();
  List optional();
};

struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  VkPhysicalDeviceType type{};
  uint32_t queueFamily = 0;
  DeviceInfo info;
};

// VK_NULL_HANDLE when there is no driver at all. debugUtils tells whether VK_EXT_debug_utils is on.
// Throws Error(NoDevice) when the validation layer is wanted and absent, or the loader is older than 1.3.
VkInstance createInstance(Validation validation, const VkDebugUtilsMessengerCreateInfoEXT* messenger,
                          bool& debugUtils);

std::vector<PhysicalDevice> physicalDevices(VkInstance instance);

// wanted: index, part of the name (any case), or "" for the best. Throws Error(NoDevice) that lists what
// there is.
const PhysicalDevice& choose(const std::vector<PhysicalDevice>& devices, const std::string& wanted);

}  // namespace fovea::gpu
