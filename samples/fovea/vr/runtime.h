// The OpenXR runtime of this computer and the headset behind it.
#pragma once

#include <vulkan/vulkan.h>
// clang-format off: the platform's header needs Vulkan's
#include <ctime>
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
// clang-format on

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fovea/device.h"

namespace fovea::vr {

// Throws Error unless the call succeeded: NoDevice where there is no runtime or headset, DeviceLost where they are lost
// or fail, OutOfMemory, and Internal for what fovea has done wrong. `what` says what was tried, in words.
void check(XrResult result, const std::string& what);

class Runtime {
 public:
  // Throws Error(NoDevice) if there is no runtime, no headset, or one that cannot be used with Vulkan.
  Runtime();
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  XrInstance instance() const { return instance_; }
  XrSystemId system() const { return system_; }
  std::string name() const;  // "Monado 21.0.0, HTC Vive"
  bool has(const char* extension) const { return extensions_.contains(extension); }
  bool tracksGaze() const { return tracksGaze_; }
  // Lets the runtime make the device, which must be done before a session begins.
  gpu::DeviceMaker deviceMaker() const;
  // Sizes in pixels that the headset recommends for each view. Throws Error(NoDevice) if it has no such configuration.
  std::vector<XrViewConfigurationView> views(XrViewConfigurationType configuration) const;

  // The present as the runtime counts time, if it says how.
  std::optional<XrTime> now() const;

  // A function of an extension.
  template <class Function>
  Function function(const char* name) const {
    PFN_xrVoidFunction found = nullptr;
    check(xrGetInstanceProcAddr(instance_, name, &found), std::string("looking for ") + name);
    return reinterpret_cast<Function>(found);
  }

  XrPath path(const char* text) const;

 private:
  void createInstance();
  void findHeadset();

  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  std::set<std::string, std::less<>> extensions_;  // those that are enabled
  std::string headset_;
  PFN_xrConvertTimespecTimeToTimeKHR toTime_ = nullptr;
  bool tracksGaze_ = false;
};

}  // namespace fovea::vr
