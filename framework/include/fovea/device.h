// The Vulkan device on which sessions run: one that fovea makes, or one that the caller has made.
//
//   std::shared_ptr<gpu::Device> device = gpu::openDevice({.device = "nvidia"});
//   graph::Session one("one.json", scene, {.device = device}), other("other.json", scene, {.device = device});
//
// One thread at a time may use a device and all sessions on it.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/error.h"

namespace fovea::gpu {

class Device;

enum class Validation { Off, On, Synchronization, GpuAssisted, BestPractices };

// What stands between an application and Vulkan, as OpenXR does (XR_KHR_vulkan_enable2): it makes the instance and the
// device that fovea describes, where it may add what it needs itself, and says which physical device that is to be.
struct DeviceMaker {
  std::function<VkResult(const VkInstanceCreateInfo&, VkInstance*)> createInstance;
  std::function<VkPhysicalDevice(VkInstance)> choose;
  std::function<VkResult(VkPhysicalDevice, const VkDeviceCreateInfo&, VkDevice*)> createDevice;
};

struct DeviceOptions {
  std::string device;  // index or part of the name; "" selects the best one (discrete, integrated, CPU)
  // Features among those that `fovea render --without` lists, to do without although the device may have them, as if it
  // lacked them.
  std::vector<std::string> without;
  Validation validation = Validation::Off;
  uint64_t memoryLimit = 0;  // bytes of device memory that fovea may use; 0 for what the device reports
  std::filesystem::path cacheDirectory;  // SPIR-V and pipeline cache; "" means $XDG_CACHE_HOME/fovea
  bool useCache = true;
  // Not set: Vulkan's loader. A maker chooses the device, so `device` must be left alone (Error(Usage)).
  std::optional<DeviceMaker> maker{};
  // Receives each validation message as it arrives, also those about the destruction of the device itself (objects
  // that were never destroyed). May be called from any thread. Messages are kept as well.
  std::function<void(const std::string&)> onValidationMessage;
};

// Opens a device. Throws Error(NoDevice) if there is no loader, no device or a missing feature (each is named),
// Error(Usage) for a feature that fovea cannot do without, Error(OutOfMemory) or Error(DeviceLost).
std::shared_ptr<Device> openDevice(const DeviceOptions& options = {});

// A device that the caller has made, and destroys after everything that uses it. While fovea works on it (in constructors,
// destructors and functions of sessions), nobody else may use its queues.
struct ExistingDevice {
  VkInstance instance = VK_NULL_HANDLE;  // made for Vulkan 1.3
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;  // of `device`, for graphics, compute and timestamps
  uint32_t queueFamily = 0;
  // What was enabled when the device was made, as in VkDeviceCreateInfo; Vulkan does not tell. The chain behind
  // `features` may hold VkPhysicalDeviceVulkan11Features, -12Features and -13Features; a feature that these structures
  // do not name counts as not enabled. Both are read only by openDevice().
  const VkPhysicalDeviceFeatures2* features = nullptr;
  std::vector<std::string> extensions;  // e.g. "VK_KHR_push_descriptor"
};

// Uses such a device. `options` must leave `device`, `maker`, `validation` and `onValidationMessage` alone, which
// whoever makes a device decides (Error(Usage)). Throws Error(NoDevice) with everything that the device lacks: features that are not
// enabled, Vulkan 1.3, or operations of the queue.
std::shared_ptr<Device> openDevice(const ExistingDevice& existing, const DeviceOptions& options = {});

// Shaders that are compiled from now on are read from their files again.
void rereadShaders(Device& device);

// "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6", then what it was told to do without; part of every report.
std::string nameOf(const Device& device);

}  // namespace fovea::gpu
