// Instance and physical devices: which exist, what each of them lacks, and which one to choose.
#pragma once

#include <vulkan/vulkan.h>

#include <string>
#include <utility>
#include <vector>

#include "framework/gpu/device.h"

namespace fovea::gpu {

// The features of Vulkan 1.0 to 1.3, and those of rays, as one pNext chain. Not copyable, because it points into itself.
struct FeatureChain {
  FeatureChain();
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan13Features v13{};
  VkPhysicalDeviceAccelerationStructureFeaturesKHR structures{};
  VkPhysicalDeviceRayQueryFeaturesKHR rayQueries{};

  // Adds the last two to the chain, which only devices with their extensions know.
  void linkRays() { v13.pNext = &structures; }
  // Whether shaders can trace rays by ray queries.
  bool haveRays() const {
    return rayQueries.rayQuery && structures.accelerationStructure && v12.bufferDeviceAddress;
  }

  using List = std::vector<std::pair<const char*, VkBool32*>>;
  List required();
  List dispensable();  // those of dispensableFeatures() that are features in the strict sense
  List optional();
  // Takes over what another chain says; of features that are in none of its structures, nothing.
  void read(const VkPhysicalDeviceFeatures2& chain);
};

// What a device must have for ray queries.
inline constexpr const char* kRayExtensions[] = {VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                                 VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                                 VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

// Throws Error(Usage) listing dispensableFeatures() if it is none of them.
void requireDispensable(const std::string& feature);

struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  VkPhysicalDeviceType type{};
  uint32_t queueFamily = 0;
  DeviceInfo info;
};

// VK_NULL_HANDLE if there is no driver at all. `debugUtils` tells whether VK_EXT_debug_utils is enabled. `maker` takes
// the place of Vulkan's loader unless it is nullptr. Throws
// Error(NoDevice) if the validation layer is requested but absent, if the loader is older than 1.3, or if a driver or a
// layer or its description is damaged, and Error(OutOfMemory).
VkInstance createInstance(Validation validation, const VkDebugUtilsMessengerCreateInfoEXT* messenger,
                          bool& debugUtils, const DeviceMaker* maker = nullptr);

// Those whose driver cannot say what they offer lack that. Throws Error(NoDevice) and Error(OutOfMemory).
std::vector<PhysicalDevice> physicalDevices(VkInstance instance);

// A device that somebody else has made, with what is enabled as what there is; `enabled` receives its features. Throws
// Error(Usage) if a handle is missing and Error(NoDevice) with all that the device lacks.
PhysicalDevice describeExisting(const ExistingDevice& existing, FeatureChain& enabled);

// `wanted` is an index, part of the name (in any case), or "" for the best device. Throws Error(NoDevice) listing the
// devices that exist.
const PhysicalDevice& choose(const std::vector<PhysicalDevice>& devices, const std::string& wanted);

}  // namespace fovea::gpu
