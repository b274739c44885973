// Compute and graphics pipelines whose layout comes from reflection. Set 0 belongs to the pass and is written for each
// command (Device::pushDescriptorSet); set 1 is shared by all passes of a frame. Layouts differ in set 0, so set 1 must
// be bound again after each change of pipeline.
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <string>
#include <vector>

#include "framework/gpu/shader/shader.h"

namespace fovea::gpu {

class Device;

// What both kinds of pipeline have in common: the merged bindings and push constants of all stages. A name
// is one binding in all stages. Numbers that the compiler chose are changed where stages disagree;
// explicit numbers must agree.
struct PipelineInterface {
  std::vector<ReflectedBinding> bindings;  // set 0 only
  std::vector<ReflectedMember> constants;
  uint32_t pushConstantBytes = 0;
  VkShaderStageFlags stages = 0;
  bool usesSharedSet = false;  // a stage has a binding in set 1
  uint32_t localSize[3] = {1, 1, 1};
};

struct ComputePipelineDesc {
  std::shared_ptr<const CompiledShader> shader;
  VkDescriptorSetLayout sharedSet = VK_NULL_HANDLE;  // layout of set 1; required if the shader uses it
  // Whether the interface suffices, as the shader runs on the host. Drivers take seconds to build pipelines that trace
  // rays.
  bool onlyInterface = false;
};

struct GraphicsPipelineDesc {
  std::shared_ptr<const CompiledShader> vertex, fragment;  // fragment may be null (depth only)
  VkDescriptorSetLayout sharedSet = VK_NULL_HANDLE;
  std::vector<VkFormat> colorFormats;
  VkFormat depthFormat = VK_FORMAT_UNDEFINED;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;  // front faces are counter-clockwise, as in glTF
  bool depthTest = true, depthWrite = true;
  VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
  bool additiveBlend = false;
  float depthBiasConstant = 0, depthBiasSlope = 0;
  uint32_t clipDistances = 0;
};

// Move-only. Viewport and scissor are dynamic state; rendering is dynamic; there is no vertex
// input (vertices are pulled).
class Pipeline {
 public:
  Pipeline() = default;
  Pipeline(Device& device, const ComputePipelineDesc& desc);
  Pipeline(Device& device, const GraphicsPipelineDesc& desc);
  ~Pipeline();
  Pipeline(Pipeline&& other) noexcept;
  Pipeline& operator=(Pipeline&& other) noexcept;

  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  VkPipeline handle() const { return handle_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipelineBindPoint bindPoint() const { return bindPoint_; }
  const PipelineInterface& interface() const { return interface_; }
  const std::string& name() const { return name_; }

 private:
  void createLayout(VkDescriptorSetLayout sharedSet);
  void destroy();
  Device* device_ = nullptr;
  std::string name_;
  PipelineInterface interface_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline handle_ = VK_NULL_HANDLE;
  VkPipelineBindPoint bindPoint_ = VK_PIPELINE_BIND_POINT_COMPUTE;
};

VkDescriptorType descriptorType(BindingKind kind);

// The stages of one pipeline, made consistent: spirv[i] is shaders[i] with its final binding numbers. mergeStages()
// throws Error(BadInput) naming the shaders and the resource if they contradict each other or if a set other than 0
// and 1 is used.
struct MergedStages {
  PipelineInterface interface;
  std::vector<std::vector<uint32_t>> spirv;
};
MergedStages mergeStages(const std::vector<std::shared_ptr<const CompiledShader>>& shaders);

}  // namespace fovea::gpu
