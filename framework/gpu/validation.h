// What the validation layers say.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "fovea/device.h"

namespace fovea::gpu {

struct MessageLog {
  Validation validation = Validation::Off;
  std::function<void(const std::string&)> forward;
  std::mutex mutex;
  std::vector<std::string> messages;
};

// To be called by the layers, with a MessageLog as `user`. Keeps those messages that point to a mistake of fovea.
VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT type,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);

}  // namespace fovea::gpu
