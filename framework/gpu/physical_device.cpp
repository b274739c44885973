#include "framework/gpu/physical_device.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

#include "fovea/error.h"
#include "framework/gpu/loader/driver_files.h"

namespace fovea::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kTexelLimit = "maxTexelBufferElements";
constexpr uint32_t kTexels = 1 << 24;  // less are too few for lists of voxels and for large scenes
constexpr const char* kSnormAttachments = "VK_FORMAT_R16G16_SNORM";  // as colour attachments
constexpr const char* kDispensableExtensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
constexpr const char* kRays = VK_KHR_RAY_QUERY_EXTENSION_NAME;  // stands for all of kRayExtensions

std::string versionText(uint32_t v) {
  return std::to_string(VK_API_VERSION_MAJOR(v)) + "." + std::to_string(VK_API_VERSION_MINOR(v)) + "." +
         std::to_string(VK_API_VERSION_PATCH(v));
}

const char* typeName(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

// Higher ranks are better.
int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 1;
    default:
      return 0;
  }
}

bool hasExtension(const std::vector<VkExtensionProperties>& list, const char* name) {
  return std::any_of(list.begin(), list.end(),
                     [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

// A list that a function of Vulkan gives in two calls, with its length and its items. It may grow in between.
template <class Item, class List>
VkResult listed(std::vector<Item>& items, const List& list) {
  uint32_t count = 0;
  VkResult result = VK_INCOMPLETE;
  for (int attempt = 0; result == VK_INCOMPLETE && attempt < 10; ++attempt) {
    result = list(&count, nullptr);
    if (result != VK_SUCCESS) break;
    items.resize(count);
    result = list(&count, items.data());
  }
  items.resize(result == VK_SUCCESS ? count : 0);
  return result;
}

// Of the loader, which reports a lack of memory also when it cannot read the description of a driver.
void checkLoader(VkResult result, const std::string& what) {
  if (result == VK_SUCCESS) return;
  const std::filesystem::path damaged =
      result == VK_ERROR_OUT_OF_HOST_MEMORY ? damagedDriverFile() : std::filesystem::path();
  if (!damaged.empty())
    throw Error(ExitCode::NoDevice,
                "the Vulkan loader does not start, because the description of a driver, " + damaged.string() +
                    ", is damaged",
                "install the driver again, or remove the file");
  if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
    checkOpening(result, what);
  throw Error(ExitCode::NoDevice,
              "the Vulkan loader does not start: " + what + " failed: " + resultName(result),
              "a driver, a layer or the description of one (a .json file in vulkan/icd.d, or named in "
              "VK_DRIVER_FILES or VK_ICD_FILENAMES) is damaged: install it again");
}

std::vector<VkExtensionProperties> instanceExtensions(const char* layer) {
  std::vector<VkExtensionProperties> list;
  checkLoader(listed(list,
                     [&](uint32_t* count, VkExtensionProperties* items) {
                       return vkEnumerateInstanceExtensionProperties(layer, count, items);
                     }),
              "listing the extensions");
  return list;
}

void requireValidationLayer() {
  std::vector<VkLayerProperties> layers;
  checkLoader(listed(layers,
                     [](uint32_t* count, VkLayerProperties* items) {
                       return vkEnumerateInstanceLayerProperties(count, items);
                     }),
              "listing the layers");
  for (const VkLayerProperties& layer : layers) {
    if (std::strcmp(layer.layerName, kValidationLayer) == 0) return;
  }
  throw Error(
      ExitCode::NoDevice,
      std::string("validation was asked for, but the Vulkan layer ") + kValidationLayer + " is not installed",
      "install vulkan-validationlayers, or run without validation");
}

std::vector<VkValidationFeatureEnableEXT> validationEnables(Validation validation) {
  switch (validation) {
    case Validation::Synchronization:
      return {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    case Validation::GpuAssisted:
      return {VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
              VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
    case Validation::BestPractices:
      return {VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT};
    case Validation::Off:
    case Validation::On:
      break;
  }
  return {};
}

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

constexpr const char* kQueueNeeds = "a queue with graphics, compute and timestamps";

bool isEnough(const VkQueueFamilyProperties& family) {
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  return (family.queueFlags & kNeeded) == kNeeded && family.timestampValidBits > 0;
}

// The first family that supports everything; -1 if there is none.
int findQueueFamily(VkPhysicalDevice device) {
  const std::vector<VkQueueFamilyProperties> families = queueFamilies(device);
  const auto found = std::find_if(families.begin(), families.end(), isEnough);
  return found == families.end() ? -1 : int(found - families.begin());
}

// All but the place in a chain.
template <class Features>
void copyFeatures(const VkBaseInStructure& from, Features& to) {
  void* const next = to.pNext;
  to = reinterpret_cast<const Features&>(from);
  to.pNext = next;
}

std::vector<std::string> missingFeatures(VkPhysicalDevice device,
                                         const VkPhysicalDeviceProperties& properties) {
  if (properties.apiVersion < VK_API_VERSION_1_3)
    return {"Vulkan 1.3 (it offers " + versionText(properties.apiVersion) + ")"};
  std::vector<std::string> missing;
  FeatureChain features;
  vkGetPhysicalDeviceFeatures2(device, &features.core);
  for (const auto& [name, value] : features.required()) {
    if (!*value) missing.push_back(name);
  }
  if (findQueueFamily(device) < 0) missing.emplace_back(kQueueNeeds);
  return missing;
}

std::vector<std::string> missingDispensables(VkPhysicalDevice device,
                                             const std::vector<VkExtensionProperties>& extensions) {
  std::vector<std::string> missing;
  FeatureChain features;
  const bool rays =
      std::ranges::all_of(kRayExtensions, [&](const char* name) { return hasExtension(extensions, name); });
  if (rays) features.linkRays();
  vkGetPhysicalDeviceFeatures2(device, &features.core);
  for (const auto& [name, value] : features.dispensable()) {
    if (!*value) missing.push_back(name);
  }
  if (!features.haveRays()) missing.emplace_back(kRays);
  for (const char* name : kDispensableExtensions) {
    if (!hasExtension(extensions, name)) missing.push_back(name);
  }
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(device, &properties);
  if (properties.limits.maxTexelBufferElements < kTexels) missing.emplace_back(kTexelLimit);
  VkFormatProperties snorm;
  vkGetPhysicalDeviceFormatProperties(device, VK_FORMAT_R16G16_SNORM, &snorm);
  if (!(snorm.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT))
    missing.emplace_back(kSnormAttachments);
  return missing;
}

PhysicalDevice describe(VkPhysicalDevice handle, uint32_t index) {
  PhysicalDevice d;
  d.handle = handle;
  VkPhysicalDeviceProperties base;
  vkGetPhysicalDeviceProperties(handle, &base);
  d.type = base.deviceType;
  d.info.index = index;
  d.info.name = base.deviceName;
  d.info.type = typeName(base.deviceType);
  d.info.apiVersion = versionText(base.apiVersion);
  if (base.apiVersion >= VK_API_VERSION_1_2) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(handle, &properties);
    d.info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  }
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(handle, &memory);
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      d.info.memoryBytes = std::max<uint64_t>(d.info.memoryBytes, memory.memoryHeaps[i].size);
  }
  d.info.missing = missingFeatures(handle, base);
  if (d.info.missing.empty()) {
    std::vector<VkExtensionProperties> extensions;
    const VkResult result = listed(extensions, [&](uint32_t* count, VkExtensionProperties* items) {
      return vkEnumerateDeviceExtensionProperties(handle, nullptr, count, items);
    });
    // A device whose driver is damaged must not hide the others.
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
      checkOpening(result, "listing the extensions of the device `" + d.info.name + "`");
    if (result == VK_SUCCESS)
      d.info.without = missingDispensables(handle, extensions);
    else
      d.info.missing.push_back(std::string("a list of its extensions (") + resultName(result) + ")");
  }
  d.queueFamily = uint32_t(std::max(0, findQueueFamily(handle)));
  return d;
}

std::string lower(std::string s) {
  for (char& c : s) c = char(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

std::string join(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : ", ") + item;
  return text;
}

std::string listing(const std::vector<PhysicalDevice>& devices) {
  std::string text;
  for (const PhysicalDevice& d : devices) {
    text += "\n     " + std::to_string(d.info.index) + ": " + d.info.name + " (" + d.info.type + ")";
    if (!d.info.missing.empty()) text += ", not usable: it lacks " + join(d.info.missing);
  }
  return text;
}

bool matches(const PhysicalDevice& d, const std::string& wanted) {
  if (wanted.empty()) return true;
  uint32_t index = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
  if (error == std::errc() && end == wanted.data() + wanted.size()) return d.info.index == index;
  return lower(d.info.name).find(lower(wanted)) != std::string::npos;
}

}  // namespace

FeatureChain::FeatureChain() {
  core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
  structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
  structures.pNext = &rayQueries;
  rayQueries.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
}

void FeatureChain::read(const VkPhysicalDeviceFeatures2& chain) {
  for (auto* link = reinterpret_cast<const VkBaseInStructure*>(&chain); link; link = link->pNext) {
    if (link->sType == core.sType) copyFeatures(*link, core);
    if (link->sType == v11.sType) copyFeatures(*link, v11);
    if (link->sType == v12.sType) copyFeatures(*link, v12);
    if (link->sType == v13.sType) copyFeatures(*link, v13);
    if (link->sType == structures.sType) copyFeatures(*link, structures);
    if (link->sType == rayQueries.sType) copyFeatures(*link, rayQueries);
  }
}

FeatureChain::List FeatureChain::required() {
  VkPhysicalDeviceFeatures& f = core.features;
  return {
      {"shaderClipDistance", &f.shaderClipDistance},
      {"multiDrawIndirect", &f.multiDrawIndirect},
      {"drawIndirectFirstInstance", &f.drawIndirectFirstInstance},
      {"fragmentStoresAndAtomics", &f.fragmentStoresAndAtomics},
      {"vertexPipelineStoresAndAtomics", &f.vertexPipelineStoresAndAtomics},
      {"independentBlend", &f.independentBlend},
      {"imageCubeArray", &f.imageCubeArray},
      {"shaderStorageImageExtendedFormats", &f.shaderStorageImageExtendedFormats},
      {"hostQueryReset", &v12.hostQueryReset},
      {"timelineSemaphore", &v12.timelineSemaphore},
      {"scalarBlockLayout", &v12.scalarBlockLayout},
      {"dynamicRendering", &v13.dynamicRendering},
      {"synchronization2", &v13.synchronization2},
      {"maintenance4", &v13.maintenance4},  // LocalSizeId, requirements without objects
      {"shaderDemoteToHelperInvocation", &v13.shaderDemoteToHelperInvocation},
      {"shaderTerminateInvocation", &v13.shaderTerminateInvocation},  // `discard` in SPIR-V 1.6
  };
}

FeatureChain::List FeatureChain::dispensable() {
  return {{"geometryShader", &core.features.geometryShader},
          {"shaderInt64", &core.features.shaderInt64},
          {"shaderDrawParameters", &v11.shaderDrawParameters},
          {"shaderOutputLayer", &v12.shaderOutputLayer}};
}

std::vector<std::string> dispensableFeatures() {
  std::vector<std::string> names;
  FeatureChain features;
  for (const auto& [name, value] : features.dispensable()) names.push_back(name);
  names.insert(names.end(), std::begin(kDispensableExtensions), std::end(kDispensableExtensions));
  names.emplace_back(kRays);
  names.emplace_back(kTexelLimit);
  names.emplace_back(kSnormAttachments);
  return names;
}

void requireDispensable(const std::string& feature) {
  const std::vector<std::string> names = dispensableFeatures();
  if (std::find(names.begin(), names.end(), feature) != names.end()) return;
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw Error(ExitCode::Usage, "fovea cannot do without `" + feature + "`", "it can do without " + list);
}

FeatureChain::List FeatureChain::optional() {
  VkPhysicalDeviceFeatures& f = core.features;
  return {
      {"shaderFloat64", &f.shaderFloat64},
      {"shaderInt16", &f.shaderInt16},
      {"samplerAnisotropy", &f.samplerAnisotropy},
      {"depthClamp", &f.depthClamp},
      {"largePoints", &f.largePoints},
      {"shaderImageGatherExtended", &f.shaderImageGatherExtended},
      {"shaderStorageImageReadWithoutFormat", &f.shaderStorageImageReadWithoutFormat},
      {"shaderStorageImageWriteWithoutFormat", &f.shaderStorageImageWriteWithoutFormat},
      {"shaderUniformBufferArrayDynamicIndexing", &f.shaderUniformBufferArrayDynamicIndexing},
      {"shaderStorageBufferArrayDynamicIndexing", &f.shaderStorageBufferArrayDynamicIndexing},
      {"shaderSampledImageArrayDynamicIndexing", &f.shaderSampledImageArrayDynamicIndexing},
      {"shaderBufferInt64Atomics", &v12.shaderBufferInt64Atomics},
      {"shaderSharedInt64Atomics", &v12.shaderSharedInt64Atomics},
      {"drawIndirectCount", &v12.drawIndirectCount},
      {"storageBuffer8BitAccess", &v12.storageBuffer8BitAccess},
      {"storageBuffer16BitAccess", &v11.storageBuffer16BitAccess},
      {"bufferDeviceAddress", &v12.bufferDeviceAddress},  // for rays and GPU-assisted validation
      {"subgroupSizeControl", &v13.subgroupSizeControl},
      {"computeFullSubgroups", &v13.computeFullSubgroups},
      {"shaderZeroInitializeWorkgroupMemory", &v13.shaderZeroInitializeWorkgroupMemory},
  };
}

VkInstance createInstance(Validation validation, const VkDebugUtilsMessengerCreateInfoEXT* messenger,
                          bool& debugUtils, const DeviceMaker* maker) {
  uint32_t loader = VK_API_VERSION_1_0;
  checkLoader(vkEnumerateInstanceVersion(&loader), "asking for its version");
  if (loader < VK_API_VERSION_1_3) {
    throw Error(ExitCode::NoDevice,
                "the Vulkan loader is version " + versionText(loader) + "; fovea needs 1.3",
                "install a newer libvulkan1");
  }
  std::vector<VkExtensionProperties> available = instanceExtensions(nullptr);
  std::vector<const char*> layers, extensions;
  if (validation != Validation::Off) {
    requireValidationLayer();
    layers.push_back(kValidationLayer);
    for (const VkExtensionProperties& e : instanceExtensions(kValidationLayer)) available.push_back(e);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
  }
  debugUtils = hasExtension(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

  const std::vector<VkValidationFeatureEnableEXT> enables = validationEnables(validation);
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = uint32_t(enables.size());
  features.pEnabledValidationFeatures = enables.data();
  VkDebugUtilsMessengerCreateInfoEXT creationMessenger{};
  if (debugUtils && messenger) {  // reports mistakes in creating and destroying the instance, too
    creationMessenger = *messenger;
    features.pNext = &creationMessenger;
  }
  VkApplicationInfo app{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  app.pApplicationName = "fovea";
  app.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  if (validation != Validation::Off) info.pNext = &features;
  info.pApplicationInfo = &app;
  info.enabledLayerCount = uint32_t(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkInstance instance = VK_NULL_HANDLE;
  const VkResult result =
      maker ? maker->createInstance(info, &instance) : vkCreateInstance(&info, nullptr, &instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return VK_NULL_HANDLE;
  checkLoader(result, "creating the Vulkan instance");
  return instance;
}

std::vector<PhysicalDevice> physicalDevices(VkInstance instance) {
  if (!instance) return {};
  std::vector<VkPhysicalDevice> handles;
  const VkResult result = listed(handles, [&](uint32_t* count, VkPhysicalDevice* items) {
    return vkEnumeratePhysicalDevices(instance, count, items);
  });
  if (result == VK_ERROR_INITIALIZATION_FAILED || result == VK_ERROR_INCOMPATIBLE_DRIVER) return {};
  checkOpening(result, "listing the Vulkan devices");
  std::vector<PhysicalDevice> list;
  for (uint32_t i = 0; i < handles.size(); ++i) list.push_back(describe(handles[i], i));
  return list;
}

PhysicalDevice describeExisting(const ExistingDevice& existing, FeatureChain& enabled) {
  const std::pair<const char*, const void*> handles[] = {{"instance", existing.instance},
                                                         {"physical", existing.physical},
                                                         {"device", existing.device},
                                                         {"queue", existing.queue},
                                                         {"features", existing.features}};
  for (const auto& [member, value] : handles)
    if (!value)
      throw Error(ExitCode::Usage, std::string("ExistingDevice::") + member + " is not set",
                  "fill every member of ExistingDevice but `extensions`, which may be empty");
  PhysicalDevice d = describe(existing.physical, 0);
  enabled.read(*existing.features);
  const auto missOnce = [](std::vector<std::string>& list, const char* name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.emplace_back(name);
  };
  for (const auto& [name, value] : enabled.required())
    if (!*value) missOnce(d.info.missing, name);
  for (const auto& [name, value] : enabled.dispensable())
    if (!*value) missOnce(d.info.without, name);
  if (!enabled.haveRays()) missOnce(d.info.without, kRays);
  for (const char* name : kDispensableExtensions)
    if (std::find(existing.extensions.begin(), existing.extensions.end(), name) == existing.extensions.end())
      missOnce(d.info.without, name);
  const std::vector<VkQueueFamilyProperties> families = queueFamilies(existing.physical);
  d.queueFamily = existing.queueFamily;
  if (d.queueFamily >= families.size() || !isEnough(families[d.queueFamily]))
    missOnce(d.info.missing, kQueueNeeds);
  if (!d.info.missing.empty())
    throw Error(ExitCode::NoDevice,
                "the device that was handed in, `" + d.info.name + "`, lacks " + join(d.info.missing),
                "enable that when you make the device, and say so in ExistingDevice");
  return d;
}

const PhysicalDevice& choose(const std::vector<PhysicalDevice>& devices, const std::string& wanted) {
  if (devices.empty()) {
    throw Error(ExitCode::NoDevice,
                "no Vulkan device found: there is no driver, or none of them found its hardware",
                "install the driver of your GPU, or mesa-vulkan-drivers for the software device (lavapipe)");
  }
  const PhysicalDevice* best = nullptr;
  const PhysicalDevice* unusable = nullptr;
  for (const PhysicalDevice& d : devices) {
    if (!matches(d, wanted)) continue;
    if (!d.info.missing.empty()) {
      unusable = &d;
    } else if (!best || rank(d.type) > rank(best->type)) {
      best = &d;
    }
  }
  if (best) return *best;
  if (unusable && !wanted.empty()) {
    throw Error(ExitCode::NoDevice,
                "device `" + unusable->info.name + "` lacks " + join(unusable->info.missing),
                "update its driver or choose another one:" + listing(devices));
  }
  if (unusable) {
    throw Error(ExitCode::NoDevice, "no usable Vulkan device:" + listing(devices),
                "update the driver, or install mesa-vulkan-drivers for the software device (lavapipe)");
  }
  throw Error(ExitCode::NoDevice, "no device has the index or name `" + wanted + "`",
              "choose one of these:" + listing(devices));
}

}  // namespace fovea::gpu
