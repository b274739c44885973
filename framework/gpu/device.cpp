#include "framework/gpu/device.h"

#include <xxhash.h>

#include <algorithm>
#include <map>
#include <utility>

#include "fovea/error.h"
#include "framework/gpu/descriptor_pools.h"
#include "framework/gpu/device_memory.h"
#include "framework/gpu/physical_device.h"
#include "framework/gpu/shader/disk_cache.h"
#include "framework/gpu/shader/shader.h"
#include "framework/gpu/validation.h"

namespace fovea::gpu {
namespace {

template <class F>
F load(VkInstance instance, const char* name) {
  return reinterpret_cast<F>(vkGetInstanceProcAddr(instance, name));
}

const PhysicalDevice& chosenBy(const DeviceMaker& maker, VkInstance instance,
                               const std::vector<PhysicalDevice>& devices) {
  const auto found = std::ranges::find(devices, maker.choose(instance), &PhysicalDevice::handle);
  if (found == devices.end())
    throw Error(ExitCode::NoDevice, "the Vulkan device that the display needs does not exist",
                "install the driver of the GPU to which it is connected");
  return choose(devices, std::to_string(found->info.index));  // which refuses one that lacks something
}

}  // namespace

std::vector<DeviceInfo> listDevices() {
  bool debugUtils = false;
  const struct Scope {
    VkInstance instance;
    ~Scope() {
      if (instance) vkDestroyInstance(instance, nullptr);
    }
  } scope{createInstance(Validation::Off, nullptr, debugUtils)};
  std::vector<DeviceInfo> list;
  for (PhysicalDevice& d : physicalDevices(scope.instance)) list.push_back(std::move(d.info));
  return list;
}

struct Device::Impl {
  ~Impl();
  void createInstanceAndMessenger(const DeviceOptions& options);
  void loadLabels();
  void choose(const PhysicalDevice& chosen, const std::vector<std::string>& without);
  bool lacks(std::string_view feature) const;
  void chooseFeatures(FeatureChain& enabled) const;
  void createDevice(const FeatureChain& enabled, const DeviceMaker* maker);
  void start(const FeatureChain& enabled, const DeviceOptions& options);
  void describe(const FeatureChain& enabled);
  void createCaches(const DeviceOptions& options);
  void savePipelineCache();

  MessageLog log;
  bool existing = false;  // instance and device are the caller's
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  DeviceInfo info;  // `without` includes what the options say
  std::string name;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkPhysicalDeviceType type{};
  VkPhysicalDeviceProperties properties{};
  uint64_t maxAllocation = 0, maxBuffer = 0;
  uint32_t maxPushDescriptors = 0;
  Features features;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkPipelineCache pipelineCache = VK_NULL_HANDLE;
  std::filesystem::path pipelineCacheFile;  // empty if not kept on disk
  uint64_t pipelineCacheHash = 0;           // hash of the loaded data
  std::unique_ptr<ShaderCompiler> shaders;
  std::map<std::pair<VkFilter, VkSamplerAddressMode>, VkSampler> samplers;
  std::unique_ptr<DescriptorPools> plainSets;  // where descriptors are not pushed
  std::unique_ptr<DeviceMemory> memory;

  PFN_vkCmdPushDescriptorSetKHR pushDescriptorSet = nullptr;
  PFN_vkSetDebugUtilsObjectNameEXT setName = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;
};

Device::Impl::~Impl() {
  if (device) {
    vkDeviceWaitIdle(device);
    savePipelineCache();
    plainSets.reset();
    for (const auto& [key, handle] : samplers) vkDestroySampler(device, handle, nullptr);
    vkDestroyPipelineCache(device, pipelineCache, nullptr);
    vkDestroyCommandPool(device, pool, nullptr);
  }
  if (existing) return;
  if (device) vkDestroyDevice(device, nullptr);
  if (messenger)
    load<PFN_vkDestroyDebugUtilsMessengerEXT>(instance, "vkDestroyDebugUtilsMessengerEXT")(
        instance, messenger, nullptr);
  if (instance) vkDestroyInstance(instance, nullptr);
}

void Device::Impl::createInstanceAndMessenger(const DeviceOptions& options) {
  log.validation = options.validation;
  log.forward = options.onValidationMessage;
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  // GENERAL contains the loader's messages about drivers without hardware; PERFORMANCE belongs to best practices.
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  if (options.validation == Validation::BestPractices)
    info.messageType |= VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = onMessage;
  info.pUserData = &log;
  bool debugUtils = false;
  instance = createInstance(options.validation, &info, debugUtils, options.maker ? &*options.maker : nullptr);
  if (!instance || !debugUtils) return;
  if (options.validation != Validation::Off) {
    const auto create = load<PFN_vkCreateDebugUtilsMessengerEXT>(instance, "vkCreateDebugUtilsMessengerEXT");
    checkOpening(create(instance, &info, nullptr, &messenger), "creating the validation messenger");
  }
  loadLabels();
}

// There are none unless VK_EXT_debug_utils is enabled.
void Device::Impl::loadLabels() {
  setName = load<PFN_vkSetDebugUtilsObjectNameEXT>(instance, "vkSetDebugUtilsObjectNameEXT");
  beginLabel = load<PFN_vkCmdBeginDebugUtilsLabelEXT>(instance, "vkCmdBeginDebugUtilsLabelEXT");
  endLabel = load<PFN_vkCmdEndDebugUtilsLabelEXT>(instance, "vkCmdEndDebugUtilsLabelEXT");
}

void Device::Impl::chooseFeatures(FeatureChain& enabled) const {
  FeatureChain available;
  vkGetPhysicalDeviceFeatures2(physical, &available.core);
  for (const auto& [name, value] : enabled.required()) *value = VK_TRUE;
  for (const auto& [name, value] : enabled.dispensable()) *value = !lacks(name);
  if (!lacks(VK_KHR_RAY_QUERY_EXTENSION_NAME)) {
    enabled.linkRays();
    enabled.structures.accelerationStructure = enabled.rayQueries.rayQuery = VK_TRUE;
  }
  const FeatureChain::List from = available.optional(), to = enabled.optional();
  for (size_t i = 0; i < from.size(); ++i) *to[i].second = *from[i].second;
}

void Device::Impl::describe(const FeatureChain& enabled) {
  const VkPhysicalDeviceFeatures& f = enabled.core.features;
  features.geometryShader = f.geometryShader;
  features.shaderDrawParameters = enabled.v11.shaderDrawParameters;
  features.shaderOutputLayer = enabled.v12.shaderOutputLayer;
  features.shaderInt64 = f.shaderInt64;
  features.bufferInt64Atomics = enabled.v12.shaderBufferInt64Atomics;
  features.sharedInt64Atomics = enabled.v12.shaderSharedInt64Atomics;
  features.drawIndirectCount = enabled.v12.drawIndirectCount;
  features.samplerAnisotropy = f.samplerAnisotropy;
  features.depthClamp = f.depthClamp;
  features.largePoints = f.largePoints;
  features.storageReadWithoutFormat = f.shaderStorageImageReadWithoutFormat;
  features.storageWriteWithoutFormat = f.shaderStorageImageWriteWithoutFormat;
  features.sampledImageArrayDynamicIndexing = f.shaderSampledImageArrayDynamicIndexing;
  VkPhysicalDevicePushDescriptorPropertiesKHR push{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR};
  VkPhysicalDeviceVulkan13Properties v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES, &push};
  VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, &v13};
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
  vkGetPhysicalDeviceProperties2(physical, &all);
  properties = all.properties;
  maxAllocation = v11.maxMemoryAllocationSize;
  maxBuffer = v13.maxBufferSize;
  constexpr uint32_t kLeast = 32;  // that devices with push descriptors support
  maxPushDescriptors = std::max(push.maxPushDescriptors, kLeast);
  features.subgroupSize = v11.subgroupSize;
  if (v11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT)
    features.subgroupOperations = v11.subgroupSupportedOperations;
}

bool Device::Impl::lacks(std::string_view feature) const {
  return std::find(info.without.begin(), info.without.end(), feature) != info.without.end();
}

void Device::Impl::choose(const PhysicalDevice& chosen, const std::vector<std::string>& without) {
  physical = chosen.handle;
  type = chosen.type;
  info = chosen.info;
  name = info.name + ", " + info.driver;
  for (const std::string& feature : without) {
    requireDispensable(feature);
    name += ", without " + feature;
    info.without.push_back(feature);
  }
  queueFamily = chosen.queueFamily;
}

void Device::Impl::createDevice(const FeatureChain& enabled, const DeviceMaker* maker) {
  const float priority = 1;
  VkDeviceQueueCreateInfo queueInfo{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queueInfo.queueFamilyIndex = queueFamily;
  queueInfo.queueCount = 1;
  queueInfo.pQueuePriorities = &priority;
  std::vector<const char*> extensions;
  if (!lacks(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME))
    extensions.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
  if (!lacks(VK_KHR_RAY_QUERY_EXTENSION_NAME))
    extensions.insert(extensions.end(), std::begin(kRayExtensions), std::end(kRayExtensions));
  VkDeviceCreateInfo deviceInfo{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &enabled.core};
  deviceInfo.queueCreateInfoCount = 1;
  deviceInfo.pQueueCreateInfos = &queueInfo;
  deviceInfo.enabledExtensionCount = uint32_t(extensions.size());
  deviceInfo.ppEnabledExtensionNames = extensions.data();
  checkOpening(maker ? maker->createDevice(physical, deviceInfo, &device)
                     : vkCreateDevice(physical, &deviceInfo, nullptr, &device),
               "starting the device `" + info.name + "`");
  vkGetDeviceQueue(device, queueFamily, 0, &queue);
}

// What does not depend on who made the device.
void Device::Impl::start(const FeatureChain& enabled, const DeviceOptions& options) {
  describe(enabled);
  memory = std::make_unique<DeviceMemory>(physical, device, maxAllocation, options.memoryLimit,
                                          !lacks(VK_KHR_RAY_QUERY_EXTENSION_NAME));
  if (!lacks(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) && log.validation != Validation::GpuAssisted)
    pushDescriptorSet = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
        vkGetDeviceProcAddr(device, "vkCmdPushDescriptorSetKHR"));
  else
    plainSets = std::make_unique<DescriptorPools>(device);
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  poolInfo.queueFamilyIndex = queueFamily;
  checkOpening(vkCreateCommandPool(device, &poolInfo, nullptr, &pool), "creating a command pool");
  createCaches(options);
}

void Device::Impl::createCaches(const DeviceOptions& options) {
  std::filesystem::path directory;
  if (options.useCache)
    directory = options.cacheDirectory.empty() ? defaultCacheDirectory() : options.cacheDirectory;
  Defines always;
  for (const std::string& feature : info.without) always["WITHOUT_" + feature] = "1";
  if (lacks("VK_FORMAT_R16G16_SNORM"))
    always["rg16_snorm"] = "rg32f";  // storage images, see replaceFormats()
  shaders = std::make_unique<ShaderCompiler>(directory, always);
  std::vector<std::byte> initial;
  if (!directory.empty()) {
    // The UUID changes with driver and device; the driver checks it again in the header of the blob.
    std::string uuid;
    for (uint8_t byte : properties.pipelineCacheUUID) {
      uuid += "0123456789abcdef"[byte >> 4];
      uuid += "0123456789abcdef"[byte & 15];
    }
    pipelineCacheFile = directory / ("pipelines-" + uuid + ".bin");
    initial = readCacheFile(pipelineCacheFile).value_or(std::vector<std::byte>{});
  }
  VkPipelineCacheCreateInfo cacheInfo{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  cacheInfo.initialDataSize = initial.size();
  cacheInfo.pInitialData = initial.data();
  if (vkCreatePipelineCache(device, &cacheInfo, nullptr, &pipelineCache) != VK_SUCCESS) {
    cacheInfo.initialDataSize = 0;
    initial.clear();
    checkOpening(vkCreatePipelineCache(device, &cacheInfo, nullptr, &pipelineCache),
                 "creating the pipeline cache");
  }
  pipelineCacheHash = XXH3_64bits(initial.data(), initial.size());
}

void Device::Impl::savePipelineCache() {
  if (pipelineCacheFile.empty() || !pipelineCache) return;
  size_t bytes = 0;
  if (vkGetPipelineCacheData(device, pipelineCache, &bytes, nullptr) != VK_SUCCESS || bytes == 0) return;
  std::vector<std::byte> data(bytes);
  if (vkGetPipelineCacheData(device, pipelineCache, &bytes, data.data()) != VK_SUCCESS) return;
  data.resize(bytes);
  if (XXH3_64bits(data.data(), data.size()) != pipelineCacheHash) writeCacheFile(pipelineCacheFile, data);
}

Device::Device(const DeviceOptions& options) : impl_(std::make_unique<Impl>()) {
  const DeviceMaker* maker = options.maker ? &*options.maker : nullptr;
  if (maker && !options.device.empty())
    throw Error(ExitCode::Usage, "DeviceOptions::device chooses a device, and so does DeviceOptions::maker",
                "leave one of them alone");
  impl_->createInstanceAndMessenger(options);
  const std::vector<PhysicalDevice> devices = physicalDevices(impl_->instance);
  impl_->choose(maker && impl_->instance ? chosenBy(*maker, impl_->instance, devices)
                                         : gpu::choose(devices, options.device),
                options.without);
  FeatureChain enabled;
  impl_->chooseFeatures(enabled);
  impl_->createDevice(enabled, maker);
  impl_->start(enabled, options);
}

Device::Device(const ExistingDevice& existing, const DeviceOptions& options)
    : impl_(std::make_unique<Impl>()) {
  if (!options.device.empty() || options.maker || options.validation != Validation::Off ||
      options.onValidationMessage)
    throw Error(ExitCode::Usage, "DeviceOptions choose a device or validation for one that exists already",
                "leave `device`, `maker`, `validation` and `onValidationMessage` as they are");
  impl_->existing = true;
  FeatureChain enabled;
  impl_->choose(describeExisting(existing, enabled), options.without);
  impl_->instance = existing.instance;
  impl_->device = existing.device;
  impl_->queue = existing.queue;
  impl_->loadLabels();
  impl_->start(enabled, options);
}

Device::~Device() = default;

VkInstance Device::instance() const { return impl_->instance; }
VkPhysicalDevice Device::physical() const { return impl_->physical; }
VkDevice Device::handle() const { return impl_->device; }
VkQueue Device::queue() const { return impl_->queue; }
uint32_t Device::queueFamily() const { return impl_->queueFamily; }
const VkPhysicalDeviceProperties& Device::properties() const { return impl_->properties; }
std::string Device::name() const { return impl_->name; }
bool Device::isCpu() const { return impl_->type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
const Features& Device::features() const { return impl_->features; }
bool Device::lacks(std::string_view feature) const { return impl_->lacks(feature); }
float Device::timestampPeriodNs() const { return impl_->properties.limits.timestampPeriod; }
uint32_t Device::maxPushDescriptors() const { return impl_->maxPushDescriptors; }
uint64_t Device::maxBufferBytes() const { return impl_->maxBuffer; }
VkPipelineCache Device::pipelineCache() const { return impl_->pipelineCache; }
ShaderCompiler& Device::shaders() const { return *impl_->shaders; }

VkDeviceMemory Device::allocate(uint64_t bytes, uint32_t memoryTypeBits, VkMemoryPropertyFlags flags,
                                const std::string& what) {
  const VkDeviceMemory memory = impl_->memory->allocate(bytes, memoryTypeBits, flags, what);
  setName(VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<uint64_t>(memory), what);
  return memory;
}

void Device::release(VkDeviceMemory memory) { impl_->memory->release(memory); }
bool Device::sharesMemory() const { return impl_->memory->isShared(); }
void* Device::mapped(VkDeviceMemory memory) const { return impl_->memory->mapped(memory); }
uint64_t Device::allocatedBytes() const { return impl_->memory->allocatedBytes(); }
uint64_t Device::peakAllocatedBytes() const { return impl_->memory->peakBytes(); }
uint64_t Device::memoryLimit() const {
  return impl_->memory->limit() ? impl_->memory->limit() : impl_->info.memoryBytes;
}

VkSampler Device::sampler(VkFilter filter, VkSamplerAddressMode mode) {
  VkSampler& handle = impl_->samplers[{filter, mode}];
  if (handle) return handle;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = filter;
  info.mipmapMode =
      filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = mode;
  info.maxLod = VK_LOD_CLAMP_NONE;
  check(vkCreateSampler(impl_->device, &info, nullptr, &handle), "creating a sampler");
  setName(VK_OBJECT_TYPE_SAMPLER, reinterpret_cast<uint64_t>(handle),
          filter == VK_FILTER_LINEAR ? "linear sampler" : "nearest sampler");
  return handle;
}

void Device::runOnce(const std::function<void(VkCommandBuffer)>& record) {
  // Both are released in any case; a command buffer that never ran may be freed.
  struct Scope {
    Device& device;
    Impl& d;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    ~Scope() {
      vkDestroyFence(d.device, fence, nullptr);
      if (!cmd) return;
      device.forget(cmd);
      vkFreeCommandBuffers(d.device, d.pool, 1, &cmd);
    }
  } scope{*this, *impl_};
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = impl_->pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(impl_->device, &allocate, &scope.cmd), "allocating a command buffer");
  const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
  check(vkCreateFence(impl_->device, &fenceInfo, nullptr, &scope.fence), "creating a fence");
  begin(scope.cmd);
  record(scope.cmd);
  check(vkEndCommandBuffer(scope.cmd), "ending a command buffer");
  VkCommandBufferSubmitInfo cmdInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  cmdInfo.commandBuffer = scope.cmd;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &cmdInfo;
  check(vkQueueSubmit2(impl_->queue, 1, &submit, scope.fence), "submitting set-up work");
  check(vkWaitForFences(impl_->device, 1, &scope.fence, VK_TRUE, UINT64_MAX), "waiting for set-up work");
}

void Device::waitIdle() { check(vkDeviceWaitIdle(impl_->device), "waiting for the device"); }

void Device::setName(VkObjectType type, uint64_t handle, const std::string& name) const {
  if (!impl_->setName || !handle) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = name.c_str();
  impl_->setName(impl_->device, &info);
}

void Device::beginLabel(VkCommandBuffer cmd, const char* name) const {
  if (!impl_->beginLabel) return;
  VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
  label.pLabelName = name;
  impl_->beginLabel(cmd, &label);
}

void Device::endLabel(VkCommandBuffer cmd) const {
  if (impl_->endLabel) impl_->endLabel(cmd);
}

void Device::begin(VkCommandBuffer cmd) const {
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(cmd, &info), "beginning a command buffer");
  if (impl_->plainSets) impl_->plainSets->begin(cmd);
}

void Device::forget(VkCommandBuffer cmd) const {
  if (impl_->plainSets) impl_->plainSets->forget(cmd);
}

void Device::pushDescriptorSet(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                               uint32_t set, std::span<const VkWriteDescriptorSet> writes) const {
  if (writes.empty()) return;
  if (impl_->plainSets) return impl_->plainSets->bind(cmd, point, layout, set, writes);
  impl_->pushDescriptorSet(cmd, point, layout, set, uint32_t(writes.size()), writes.data());
}

bool Device::pushesDescriptors() const { return !impl_->plainSets; }

void Device::announceLayout(VkPipelineLayout layout, VkDescriptorSetLayout set0) const {
  if (impl_->plainSets) impl_->plainSets->remember(layout, set0);
}

void Device::forgetLayout(VkPipelineLayout layout) const {
  if (impl_->plainSets) impl_->plainSets->forget(layout);
}

std::vector<std::string> Device::validationMessages() const {
  const std::lock_guard lock(impl_->log.mutex);
  return impl_->log.messages;
}

void Device::clearValidationMessages() {
  const std::lock_guard lock(impl_->log.mutex);
  impl_->log.messages.clear();
}

}  // namespace fovea::gpu
