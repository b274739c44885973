#include "samples/fovea/vr/runtime.h"

#include <fmt/format.h>
#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <cstring>

namespace fovea::vr {
namespace {

constexpr const char* kVulkan = XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME;
constexpr const char* kUsedWherePresent[] = {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME,
                                             XR_VARJO_QUAD_VIEWS_EXTENSION_NAME,
                                             XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};

const char* resultName(XrResult result) {
  switch (result) {
#define FOVEA_NAME(name, value) \
  case name:                    \
    return #name;
    XR_LIST_ENUM_XrResult(FOVEA_NAME)
#undef FOVEA_NAME
        default : return "an unknown result";
  }
}

ExitCode exitCode(XrResult result) {
  switch (result) {
    case XR_ERROR_RUNTIME_UNAVAILABLE:
    case XR_ERROR_API_VERSION_UNSUPPORTED:
    case XR_ERROR_EXTENSION_NOT_PRESENT:
    case XR_ERROR_INITIALIZATION_FAILED:
    case XR_ERROR_FORM_FACTOR_UNAVAILABLE:
    case XR_ERROR_FORM_FACTOR_UNSUPPORTED:
    case XR_ERROR_GRAPHICS_DEVICE_INVALID:
      return ExitCode::NoDevice;
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_SESSION_LOST:
    case XR_ERROR_RUNTIME_FAILURE:
      return ExitCode::DeviceLost;
    case XR_ERROR_OUT_OF_MEMORY:
    case XR_ERROR_LIMIT_REACHED:
      return ExitCode::OutOfMemory;
    default:
      return ExitCode::Internal;
  }
}

std::string remedy(XrResult result) {
  switch (result) {
    case XR_ERROR_RUNTIME_UNAVAILABLE:
      return "install an OpenXR runtime, such as Monado or SteamVR, and make it the active one, or name its "
             "manifest in XR_RUNTIME_JSON";
    case XR_ERROR_FORM_FACTOR_UNAVAILABLE:
      return "connect the headset and start its software";
    case XR_ERROR_FORM_FACTOR_UNSUPPORTED:
      return "choose a runtime for headsets";
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_SESSION_LOST:
    case XR_ERROR_RUNTIME_FAILURE:
      return "the log of the runtime may say why; start again once the headset works";
    default:
      return {};
  }
}

std::set<std::string, std::less<>> offered() {
  uint32_t count = 0;
  const char* const what = "asking the OpenXR runtime for its extensions";
  check(xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr), what);
  std::vector<XrExtensionProperties> list(count, {XR_TYPE_EXTENSION_PROPERTIES});
  check(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, list.data()), what);
  std::set<std::string, std::less<>> names;
  for (const XrExtensionProperties& extension : list) names.insert(extension.extensionName);
  return names;
}

}  // namespace

void check(XrResult result, const std::string& what) {
  if (XR_SUCCEEDED(result)) return;
  throw Error(exitCode(result), fmt::format("{} failed: {}", what, resultName(result)), remedy(result));
}

Runtime::Runtime() {
  createInstance();
  try {
    findHeadset();
  } catch (...) {
    xrDestroyInstance(instance_);
    throw;
  }
}

Runtime::~Runtime() { xrDestroyInstance(instance_); }

void Runtime::createInstance() {
  const auto there = offered();
  if (!there.contains(kVulkan))
    throw Error(
        ExitCode::NoDevice,
        fmt::format("the OpenXR runtime does not offer {}, so Vulkan cannot reach the headset", kVulkan),
        "choose another runtime, or a newer version of it");
  extensions_.insert(kVulkan);
  for (const char* name : kUsedWherePresent)
    if (there.contains(name)) extensions_.insert(name);
  std::vector<const char*> names;
  for (const std::string& name : extensions_) names.push_back(name.c_str());
  XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
  std::strncpy(info.applicationInfo.applicationName, "fovea", XR_MAX_APPLICATION_NAME_SIZE - 1);
  std::strncpy(info.applicationInfo.engineName, "fovea", XR_MAX_ENGINE_NAME_SIZE - 1);
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = uint32_t(names.size());
  info.enabledExtensionNames = names.data();
  check(xrCreateInstance(&info, &instance_), "starting OpenXR");
  if (has(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME))
    toTime_ = function<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
}

void Runtime::findHeadset() {
  XrSystemGetInfo wanted{XR_TYPE_SYSTEM_GET_INFO};
  wanted.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  check(xrGetSystem(instance_, &wanted, &system_), "looking for a headset");
  XrSystemEyeGazeInteractionPropertiesEXT gaze{XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT};
  XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES};
  const bool asks = has(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);
  if (asks) properties.next = &gaze;
  check(xrGetSystemProperties(instance_, system_, &properties), "asking what the headset can do");
  headset_ = properties.systemName;
  tracksGaze_ = asks && gaze.supportsEyeGazeInteraction;
}

std::string Runtime::name() const {
  XrInstanceProperties properties{XR_TYPE_INSTANCE_PROPERTIES};
  check(xrGetInstanceProperties(instance_, &properties), "asking for the name of the runtime");
  const XrVersion version = properties.runtimeVersion;
  return fmt::format("{} {}.{}.{}, {}", properties.runtimeName, XR_VERSION_MAJOR(version),
                     XR_VERSION_MINOR(version), XR_VERSION_PATCH(version), headset_);
}

std::optional<XrTime> Runtime::now() const {
  if (!toTime_) return std::nullopt;
  timespec clock{};
  clock_gettime(CLOCK_MONOTONIC, &clock);
  XrTime time = 0;
  if (XR_FAILED(toTime_(instance_, &clock, &time))) return std::nullopt;
  return time;
}

gpu::DeviceMaker Runtime::deviceMaker() const {
  // The specification demands the question, whatever the answer.
  XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
  check(function<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR")(
            instance_, system_, &needs),
        "asking for the version of Vulkan that the headset needs");
  if (needs.minApiVersionSupported > XR_MAKE_VERSION(1, 3, 0))
    throw Error(ExitCode::NoDevice, "the headset needs a newer Vulkan than 1.3, with which fovea works");
  gpu::DeviceMaker maker;
  maker.createInstance = [this](const VkInstanceCreateInfo& wanted, VkInstance* made) {
    XrVulkanInstanceCreateInfoKHR info{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    info.systemId = system_;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanCreateInfo = &wanted;
    VkResult result = VK_SUCCESS;
    check(
        function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR")(instance_, &info, made, &result),
        "starting Vulkan for the headset");
    return result;
  };
  maker.choose = [this](VkInstance vulkan) {
    XrVulkanGraphicsDeviceGetInfoKHR info{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
    info.systemId = system_;
    info.vulkanInstance = vulkan;
    VkPhysicalDevice device = VK_NULL_HANDLE;
    check(function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR")(instance_, &info,
                                                                                       &device),
          "asking to which GPU the headset is connected");
    return device;
  };
  maker.createDevice = [this](VkPhysicalDevice physical, const VkDeviceCreateInfo& wanted, VkDevice* made) {
    XrVulkanDeviceCreateInfoKHR info{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    info.systemId = system_;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanPhysicalDevice = physical;
    info.vulkanCreateInfo = &wanted;
    VkResult result = VK_SUCCESS;
    check(function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR")(instance_, &info, made, &result),
          "starting the GPU of the headset");
    return result;
  };
  return maker;
}

std::vector<XrViewConfigurationView> Runtime::views(XrViewConfigurationType configuration) const {
  uint32_t count = 0;
  check(xrEnumerateViewConfigurations(instance_, system_, 0, &count, nullptr), "asking for views");
  std::vector<XrViewConfigurationType> types(count);
  check(xrEnumerateViewConfigurations(instance_, system_, count, &count, types.data()), "asking for views");
  if (std::ranges::find(types, configuration) == types.end()) {
    const bool quad = configuration == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;
    throw Error(ExitCode::NoDevice,
                fmt::format("{} shows {}", name(), quad ? "no insets" : "no pictures for two eyes"),
                quad ? "take a graph without insets, such as foveal_stereo_view" : "connect another headset");
  }
  check(xrEnumerateViewConfigurationViews(instance_, system_, configuration, 0, &count, nullptr),
        "asking for the sizes of views");
  std::vector<XrViewConfigurationView> views(count, {XR_TYPE_VIEW_CONFIGURATION_VIEW});
  check(xrEnumerateViewConfigurationViews(instance_, system_, configuration, count, &count, views.data()),
        "asking for the sizes of views");
  return views;
}

XrPath Runtime::path(const char* text) const {
  XrPath path = XR_NULL_PATH;
  check(xrStringToPath(instance_, text, &path), "naming a part of the headset");
  return path;
}

}  // namespace fovea::vr
