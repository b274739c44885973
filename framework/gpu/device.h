// One Vulkan 1.3 device with one queue for graphics, compute and transfer.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/device.h"

namespace fovea::gpu {

class ShaderCompiler;

// One entry of the list that `fovea devices` prints.
struct DeviceInfo {
  uint32_t index = 0;
  std::string name, type, driver, apiVersion;
  uint64_t memoryBytes = 0;
  std::vector<std::string> missing;  // required features that it lacks; empty if usable
  std::vector<std::string> without;  // dispensable features that it lacks
};

// All physical devices, usable or not; empty if there is no Vulkan driver.
std::vector<DeviceInfo> listDevices();

// Features, extensions and limits that are used where a device has them and replaced where it does not, by Vulkan's
// names. Where one is lacking, all shaders are compiled with WITHOUT_ and its name defined.
std::vector<std::string> dispensableFeatures();

// Features beyond the required ones, which are enabled where present.
struct Features {
  bool geometryShader = false;        // gl_PrimitiveID in fragment shaders
  bool shaderDrawParameters = false;  // gl_BaseInstance, gl_DrawID
  bool shaderOutputLayer = false;     // gl_Layer from the vertex shader
  bool shaderInt64 = false;
  bool bufferInt64Atomics = false, sharedInt64Atomics = false;
  bool drawIndirectCount = false;
  bool samplerAnisotropy = false;
  bool depthClamp = false;
  bool largePoints = false;               // gl_PointSize above 1
  bool storageReadWithoutFormat = false;  // storage images without a format qualifier
  bool storageWriteWithoutFormat = false;
  bool sampledImageArrayDynamicIndexing = false;
  uint32_t subgroupSize = 1;
  VkSubgroupFeatureFlags subgroupOperations = 0;  // in compute shaders
};

// To be used by one thread at a time, except for allocate, release and the shader compiler. The constructors throw as
// openDevice() does, which also lets the compiler find the shaders of the data folders.
class Device {
 public:
  explicit Device(const DeviceOptions& options);
  Device(const ExistingDevice& existing, const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance() const;
  VkPhysicalDevice physical() const;
  VkDevice handle() const;
  VkQueue queue() const;
  uint32_t queueFamily() const;
  const VkPhysicalDeviceProperties& properties() const;
  const VkPhysicalDeviceLimits& limits() const { return properties().limits; }
  // E.g. "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6", then the features that it was told not to use; part of every
  // report.
  std::string name() const;
  bool isCpu() const;  // lavapipe and similar devices
  const Features& features() const;
  bool lacks(std::string_view feature) const;  // one of dispensableFeatures()
  float timestampPeriodNs() const;
  uint32_t maxPushDescriptors() const;  // in set 0
  uint64_t maxBufferBytes() const;
  VkPipelineCache pipelineCache() const;
  ShaderCompiler& shaders() const;

  // `what` names the resource in the out-of-memory message.
  VkDeviceMemory allocate(uint64_t bytes, uint32_t memoryTypeBits, VkMemoryPropertyFlags flags,
                          const std::string& what);
  void release(VkDeviceMemory memory);
  // Whether the host reaches the device's own memory as it does any other, so that nothing needs a copy.
  bool sharesMemory() const;
  // Where the host finds memory that was allocated; null unless it is such memory.
  void* mapped(VkDeviceMemory memory) const;
  uint64_t allocatedBytes() const;
  uint64_t peakAllocatedBytes() const;

  uint64_t memoryLimit() const;  // upper limit of allocatedBytes()

  // Shared samplers: nearest or linear (also between mips), with all mips, clamped or repeating.
  VkSampler sampler(VkFilter filter, VkSamplerAddressMode mode);

  // Records, submits and waits. For set-up work only, never inside the frame loop.
  void runOnce(const std::function<void(VkCommandBuffer)>& record);
  void waitIdle();

  // Debugger names and labels; without VK_EXT_debug_utils these do nothing.
  void setName(VkObjectType type, uint64_t handle, const std::string& name) const;
  void beginLabel(VkCommandBuffer cmd, const char* name) const;
  void endLabel(VkCommandBuffer cmd) const;
  // Begins a command buffer that is recorded again for each submission. pushDescriptorSet needs it.
  void begin(VkCommandBuffer cmd) const;
  // To be called before a command buffer that was begun so is freed.
  void forget(VkCommandBuffer cmd) const;
  void pushDescriptorSet(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                         uint32_t set, std::span<const VkWriteDescriptorSet> writes) const;
  // False without VK_KHR_push_descriptor and under GPU-assisted validation, where pushDescriptorSet binds ordinary sets
  // instead. Set layouts must then be created without the push flag.
  bool pushesDescriptors() const;
  // To be called with the layout of set 0 once a pipeline layout exists, and before it is destroyed.
  void announceLayout(VkPipelineLayout layout, VkDescriptorSetLayout set0) const;
  void forgetLayout(VkPipelineLayout layout) const;

  // Validation warnings and errors so far; tests fail if there are any.
  std::vector<std::string> validationMessages() const;
  void clearValidationMessages();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Throws Error with the exit code that corresponds to the result: OutOfMemory, DeviceLost, otherwise Internal.
void check(VkResult result, const std::string& what);
// The same for calls that look for devices and open one. Whatever is neither a lack of memory nor a lost device is the
// fault of the driver there, or of how it is installed: NoDevice.
void checkOpening(VkResult result, const std::string& what);
const char* resultName(VkResult result);

}  // namespace fovea::gpu
