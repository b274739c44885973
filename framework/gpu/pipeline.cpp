#include "framework/gpu/pipeline.h"

#include <algorithm>
#include <map>
#include <utility>

#include "fovea/error.h"
#include "framework/gpu/device.h"

namespace fovea::gpu {
namespace {

class ShaderModule {
 public:
  ShaderModule(Device& device, const std::vector<uint32_t>& spirv, const std::string& name)
      : device_(device) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = spirv.size() * sizeof(uint32_t);
    info.pCode = spirv.data();
    check(vkCreateShaderModule(device.handle(), &info, nullptr, &handle_), "creating shader `" + name + "`");
    device.setName(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<uint64_t>(handle_), name);
  }
  ~ShaderModule() { vkDestroyShaderModule(device_.handle(), handle_, nullptr); }
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit) const {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = bit;
    info.module = handle_;
    info.pName = "main";
    return info;
  }

 private:
  Device& device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

void checkWorkGroup(const Device& device, const CompiledShader& shader) {
  const uint32_t* size = shader.reflection.localSize;
  const VkPhysicalDeviceLimits& limits = device.limits();
  const uint64_t total = uint64_t(size[0]) * size[1] * size[2];
  bool fits = total <= limits.maxComputeWorkGroupInvocations;
  for (int i = 0; i < 3; ++i) fits = fits && size[i] <= limits.maxComputeWorkGroupSize[i];
  if (fits) return;
  throw Error(ExitCode::NoDevice,
              "shader `" + shader.file + "`: a work group of " + std::to_string(size[0]) + "x" +
                  std::to_string(size[1]) + "x" + std::to_string(size[2]) +
                  " exceeds this device's limit of " + std::to_string(limits.maxComputeWorkGroupInvocations) +
                  " invocations",
              "choose a smaller local_size");
}

void checkFeatures(const Device& device, const CompiledShader& shader) {
  for (const std::string& feature : shader.reflection.features) {
    if (!device.lacks(feature)) continue;
    throw Error(ExitCode::NoDevice,
                "shader `" + shader.file + "` uses " + feature + ", which `" + device.name() + "` lacks",
                "replace it where WITHOUT_" + feature + " is defined, as scene/drawn_vertex.glsl does");
  }
}

// The fixed-function state. It points into itself.
struct GraphicsState {
  explicit GraphicsState(const GraphicsPipelineDesc& desc);
  GraphicsState(const GraphicsState&) = delete;
  GraphicsState& operator=(const GraphicsState&) = delete;

  VkPipelineVertexInputStateCreateInfo vertexInput{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  std::vector<VkPipelineColorBlendAttachmentState> attachments;
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  const VkDynamicState dynamicStates[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
};

GraphicsState::GraphicsState(const GraphicsPipelineDesc& desc) {
  assembly.topology = desc.topology;
  viewport.viewportCount = viewport.scissorCount = 1;
  raster.cullMode = desc.cull;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1;
  raster.depthBiasEnable = desc.depthBiasConstant != 0 || desc.depthBiasSlope != 0;
  raster.depthBiasConstantFactor = desc.depthBiasConstant;
  raster.depthBiasSlopeFactor = desc.depthBiasSlope;
  multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const bool hasDepth = desc.depthFormat != VK_FORMAT_UNDEFINED;
  depth.depthTestEnable = hasDepth && desc.depthTest;
  depth.depthWriteEnable = hasDepth && desc.depthWrite;
  depth.depthCompareOp = desc.depthCompare;

  VkPipelineColorBlendAttachmentState attachment{};
  attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                              VK_COLOR_COMPONENT_A_BIT;
  attachment.blendEnable = desc.additiveBlend;
  attachment.srcColorBlendFactor = attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
  attachment.srcAlphaBlendFactor = attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  attachment.colorBlendOp = attachment.alphaBlendOp = VK_BLEND_OP_ADD;
  attachments.assign(desc.colorFormats.size(), attachment);
  blend.attachmentCount = uint32_t(attachments.size());
  blend.pAttachments = attachments.data();

  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamicStates;
  rendering.colorAttachmentCount = uint32_t(desc.colorFormats.size());
  rendering.pColorAttachmentFormats = desc.colorFormats.data();
  rendering.depthAttachmentFormat = desc.depthFormat;
}

}  // namespace

VkDescriptorType descriptorType(BindingKind kind) {
  switch (kind) {
    case BindingKind::UniformBuffer:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case BindingKind::StorageBuffer:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case BindingKind::UniformTexelBuffer:
      return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case BindingKind::StorageTexelBuffer:
      return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    case BindingKind::SampledImage:
      return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case BindingKind::CombinedImageSampler:
      return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case BindingKind::StorageImage:
      return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    case BindingKind::Sampler:
      return VK_DESCRIPTOR_TYPE_SAMPLER;
    case BindingKind::AccelerationStructure:
      return VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
  }
  throw Error(ExitCode::Internal, "unknown binding kind");
}

Pipeline::Pipeline(Device& device, const ComputePipelineDesc& desc)
    : device_(&device), name_(desc.shader->file) {
  checkWorkGroup(device, *desc.shader);
  checkFeatures(device, *desc.shader);
  MergedStages merged = mergeStages({desc.shader});
  interface_ = std::move(merged.interface);
  if (desc.onlyInterface) return;
  try {
    createLayout(desc.sharedSet);
    const ShaderModule module(device, merged.spirv[0], name_);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT);
    info.layout = layout_;
    check(vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &handle_),
          "creating pipeline `" + name_ + "`");
    device.setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(handle_), name_);
  } catch (...) {
    destroy();
    throw;
  }
}

Pipeline::Pipeline(Device& device, const GraphicsPipelineDesc& desc)
    : device_(&device), name_(desc.vertex->file), bindPoint_(VK_PIPELINE_BIND_POINT_GRAPHICS) {
  std::vector<std::shared_ptr<const CompiledShader>> shaders{desc.vertex};
  if (desc.fragment) {
    shaders.push_back(desc.fragment);
    name_ += " + " + desc.fragment->file;
  }
  for (const auto& shader : shaders) checkFeatures(device, *shader);
  MergedStages merged = mergeStages(shaders);
  interface_ = std::move(merged.interface);
  try {
    createLayout(desc.sharedSet);
    const ShaderModule vertex(device, merged.spirv[0], desc.vertex->file);
    std::vector<VkPipelineShaderStageCreateInfo> stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT)};
    std::unique_ptr<ShaderModule> fragment;
    if (desc.fragment) {
      fragment = std::make_unique<ShaderModule>(device, merged.spirv[1], desc.fragment->file);
      stages.push_back(fragment->stage(VK_SHADER_STAGE_FRAGMENT_BIT));
    }
    const GraphicsState state(desc);
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &state.rendering};
    info.stageCount = uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &state.vertexInput;
    info.pInputAssemblyState = &state.assembly;
    info.pViewportState = &state.viewport;
    info.pRasterizationState = &state.raster;
    info.pMultisampleState = &state.multisample;
    info.pDepthStencilState = &state.depth;
    info.pColorBlendState = &state.blend;
    info.pDynamicState = &state.dynamic;
    info.layout = layout_;
    check(vkCreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &handle_),
          "creating pipeline `" + name_ + "`");
    device.setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(handle_), name_);
  } catch (...) {
    destroy();
    throw;
  }
}

void Pipeline::createLayout(VkDescriptorSetLayout sharedSet) {
  if (interface_.usesSharedSet && !sharedSet)
    throw Error(ExitCode::Internal, "pipeline `" + name_ + "` uses set 1, but no shared set was given");
  std::map<uint32_t, VkDescriptorSetLayoutBinding> bindings;  // aliased numbers count once
  uint32_t descriptors = 0;
  for (const ReflectedBinding& b : interface_.bindings) {
    const VkDescriptorSetLayoutBinding entry{b.binding, descriptorType(b.kind), b.count, interface_.stages,
                                             nullptr};
    if (bindings.emplace(b.binding, entry).second) descriptors += b.count;
  }
  if (descriptors > device_->maxPushDescriptors()) {
    throw Error(ExitCode::NoDevice,
                "pipeline `" + name_ + "` binds " + std::to_string(descriptors) +
                    " resources; this device's maxPushDescriptors is " +
                    std::to_string(device_->maxPushDescriptors()),
                "split the pass");
  }
  if (interface_.pushConstantBytes > device_->limits().maxPushConstantsSize) {
    throw Error(ExitCode::NoDevice,
                "pipeline `" + name_ + "` has " + std::to_string(interface_.pushConstantBytes) +
                    " bytes of push constants; this device's maxPushConstantsSize is " +
                    std::to_string(device_->limits().maxPushConstantsSize),
                "move some of them into a uniform buffer");
  }
  std::vector<VkDescriptorSetLayoutBinding> list;
  for (const auto& [number, entry] : bindings) list.push_back(entry);
  VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  if (device_->pushesDescriptors()) setInfo.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  setInfo.bindingCount = uint32_t(list.size());
  setInfo.pBindings = list.data();
  check(vkCreateDescriptorSetLayout(device_->handle(), &setInfo, nullptr, &setLayout_),
        "creating the set layout of `" + name_ + "`");
  device_->setName(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, reinterpret_cast<uint64_t>(setLayout_), name_);

  const VkDescriptorSetLayout sets[2] = {setLayout_, sharedSet};
  const VkPushConstantRange range{interface_.stages, 0, interface_.pushConstantBytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = sharedSet ? 2 : 1;
  info.pSetLayouts = sets;
  info.pushConstantRangeCount = range.size ? 1 : 0;
  info.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device_->handle(), &info, nullptr, &layout_),
        "creating the pipeline layout of `" + name_ + "`");
  device_->announceLayout(layout_, setLayout_);
  device_->setName(VK_OBJECT_TYPE_PIPELINE_LAYOUT, reinterpret_cast<uint64_t>(layout_), name_);
}

Pipeline::~Pipeline() { destroy(); }

Pipeline::Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
  if (this == &other) return *this;
  destroy();
  device_ = std::exchange(other.device_, nullptr);
  name_ = std::move(other.name_);
  interface_ = std::exchange(other.interface_, {});
  setLayout_ = std::exchange(other.setLayout_, VK_NULL_HANDLE);
  layout_ = std::exchange(other.layout_, VK_NULL_HANDLE);
  handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
  bindPoint_ = other.bindPoint_;
  return *this;
}

void Pipeline::destroy() {
  if (!device_) return;
  device_->forgetLayout(layout_);
  vkDestroyPipeline(device_->handle(), handle_, nullptr);
  vkDestroyPipelineLayout(device_->handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_->handle(), setLayout_, nullptr);
  handle_ = VK_NULL_HANDLE;
  layout_ = VK_NULL_HANDLE;
  setLayout_ = VK_NULL_HANDLE;
  device_ = nullptr;
}

}  // namespace fovea::gpu
