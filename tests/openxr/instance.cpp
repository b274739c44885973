// Instance, system, and the making of the Vulkan device.
#include <cstring>

#include "tests/openxr/runtime.h"

namespace fovea::test {
namespace {

constexpr const char* kExtensions[] = {
    XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME,
    XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};
constexpr XrSystemId kSystem = 1;

// What OpenXR does wherever it fills a list: the first call asks for the number.
template <class Item, class List>
XrResult fill(const List& list, uint32_t capacity, uint32_t* count, Item* items) {
  *count = uint32_t(std::size(list));
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  for (uint32_t i = 0; i < *count; ++i) items[i] = list[i];
  return XR_SUCCESS;
}

std::vector<std::string> offered() {
  std::vector<std::string> names;
  for (const char* name : kExtensions)
    if (!runtime().script.without.contains(name)) names.emplace_back(name);
  return names;
}

XrViewConfigurationType configuration() {
  return runtime().script.views.size() == 4 ? XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO
                                            : XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
}

}  // namespace

XrResult enumerateInstanceExtensionProperties(const char*, uint32_t capacity, uint32_t* count,
                                              XrExtensionProperties* properties) {
  const std::vector<std::string> names = offered();
  *count = uint32_t(names.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  for (uint32_t i = 0; i < *count; ++i) {
    std::strcpy(properties[i].extensionName, names[i].c_str());
    properties[i].extensionVersion = 1;
  }
  return XR_SUCCESS;
}

XrResult createInstance(const XrInstanceCreateInfo* info, XrInstance* instance) {
  Runtime& r = runtime();
  const std::vector<std::string> names = offered();
  for (uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
    const std::string name = info->enabledExtensionNames[i];
    if (std::find(names.begin(), names.end(), name) == names.end()) return XR_ERROR_EXTENSION_NOT_PRESENT;
    r.extensions.insert(name);
  }
  r.alive = true;
  *instance = handleOf<XrInstance>(&r);
  return XR_SUCCESS;
}

XrResult destroyInstance(XrInstance) {
  runtime().endInstance();
  return XR_SUCCESS;
}

XrResult getInstanceProperties(XrInstance, XrInstanceProperties* properties) {
  properties->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::strcpy(properties->runtimeName, "fovea's test runtime");
  return XR_SUCCESS;
}

XrResult pollEvent(XrInstance, XrEventDataBuffer* event) {
  Runtime& r = runtime();
  if (const XrResult failed = r.scripted("xrPollEvent"); failed != XR_SUCCESS) return failed;
  if (r.events.empty()) return XR_EVENT_UNAVAILABLE;
  *event = r.events.front();
  r.events.pop_front();
  return XR_SUCCESS;
}

XrResult resultToString(XrInstance, XrResult value, char text[XR_MAX_RESULT_STRING_SIZE]) {
  std::snprintf(text, XR_MAX_RESULT_STRING_SIZE, "XrResult %d", int(value));
  return XR_SUCCESS;
}

XrResult structureTypeToString(XrInstance, XrStructureType value, char text[XR_MAX_STRUCTURE_NAME_SIZE]) {
  std::snprintf(text, XR_MAX_STRUCTURE_NAME_SIZE, "XrStructureType %d", int(value));
  return XR_SUCCESS;
}

XrResult stringToPath(XrInstance, const char* text, XrPath* path) {
  std::deque<std::string>& paths = runtime().paths;
  for (size_t i = 0; i < paths.size(); ++i)
    if (paths[i] == text) return *path = i + 1, XR_SUCCESS;
  paths.emplace_back(text);
  *path = paths.size();
  return XR_SUCCESS;
}

XrResult pathToString(XrInstance, XrPath path, uint32_t capacity, uint32_t* count, char* text) {
  const std::deque<std::string>& paths = runtime().paths;
  if (path == 0 || path > paths.size()) return XR_ERROR_PATH_INVALID;
  *count = uint32_t(paths[path - 1].size() + 1);
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  std::strcpy(text, paths[path - 1].c_str());
  return XR_SUCCESS;
}

XrResult convertTimespecTimeToTime(XrInstance, const timespec*, XrTime* time) {
  *time = runtime().session ? runtime().session->display - runtime().script.period / 2 : 0;
  return XR_SUCCESS;
}

XrResult getSystem(XrInstance, const XrSystemGetInfo* info, XrSystemId* system) {
  if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  if (!runtime().script.headset) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *system = kSystem;
  return XR_SUCCESS;
}

XrResult getSystemProperties(XrInstance, XrSystemId system, XrSystemProperties* properties) {
  properties->systemId = system;
  properties->vendorId = 0;
  std::strcpy(properties->systemName, "scripted headset");
  properties->graphicsProperties = {4096, 4096, 16};
  properties->trackingProperties = {XR_TRUE, XR_TRUE};
  for (auto* next = static_cast<XrBaseOutStructure*>(properties->next); next; next = next->next)
    if (next->type == XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT)
      reinterpret_cast<XrSystemEyeGazeInteractionPropertiesEXT*>(next)->supportsEyeGazeInteraction = XR_TRUE;
  return XR_SUCCESS;
}

XrResult enumerateEnvironmentBlendModes(XrInstance, XrSystemId, XrViewConfigurationType, uint32_t capacity,
                                        uint32_t* count, XrEnvironmentBlendMode* modes) {
  return fill(std::vector{XR_ENVIRONMENT_BLEND_MODE_OPAQUE}, capacity, count, modes);
}

XrResult enumerateViewConfigurations(XrInstance, XrSystemId, uint32_t capacity, uint32_t* count,
                                     XrViewConfigurationType* types) {
  return fill(std::vector{configuration()}, capacity, count, types);
}

XrResult getViewConfigurationProperties(XrInstance, XrSystemId, XrViewConfigurationType type,
                                        XrViewConfigurationProperties* properties) {
  if (type != configuration()) return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
  properties->viewConfigurationType = type;
  properties->fovMutable = XR_FALSE;
  return XR_SUCCESS;
}

XrResult enumerateViewConfigurationViews(XrInstance, XrSystemId, XrViewConfigurationType type,
                                         uint32_t capacity, uint32_t* count, XrViewConfigurationView* views) {
  if (type != configuration()) return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
  std::vector<XrViewConfigurationView> list;
  for (const ScriptedView& view : runtime().script.views)
    list.push_back({XR_TYPE_VIEW_CONFIGURATION_VIEW, nullptr, view.width, 4096, view.height, 4096, 1, 4});
  return fill(list, capacity, count, views);
}

// ---- XR_KHR_vulkan_enable2 -------------------------------------------------------------------------------------------

XrResult getVulkanGraphicsRequirements2(XrInstance, XrSystemId, XrGraphicsRequirementsVulkan2KHR* needs) {
  needs->minApiVersionSupported = XR_MAKE_VERSION(1, 0, 0);
  needs->maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
  return XR_SUCCESS;
}

XrResult createVulkanInstance(XrInstance, const XrVulkanInstanceCreateInfoKHR* info, VkInstance* instance,
                              VkResult* result) {
  const auto create =
      reinterpret_cast<PFN_vkCreateInstance>(info->pfnGetInstanceProcAddr(nullptr, "vkCreateInstance"));
  *result = create(info->vulkanCreateInfo, info->vulkanAllocator, instance);
  return XR_SUCCESS;
}

XrResult getVulkanGraphicsDevice2(XrInstance, const XrVulkanGraphicsDeviceGetInfoKHR* info,
                                  VkPhysicalDevice* device) {
  uint32_t one = 1;
  vkEnumeratePhysicalDevices(info->vulkanInstance, &one, device);
  return one == 1 ? XR_SUCCESS : XR_ERROR_RUNTIME_FAILURE;
}

XrResult createVulkanDevice(XrInstance, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* device,
                            VkResult* result) {
  *result = vkCreateDevice(info->vulkanPhysicalDevice, info->vulkanCreateInfo, info->vulkanAllocator, device);
  return XR_SUCCESS;
}

}  // namespace fovea::test
