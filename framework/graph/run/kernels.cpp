// Kernels: pipelines whose bindings are found by name, and the commands that use them.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

#include "fovea/error.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/run/execute_state.h"
#include "framework/scene/frame.h"

namespace fovea::graph {
namespace {

const char* kindName(gpu::BindingKind kind) {
  switch (kind) {
    case gpu::BindingKind::UniformBuffer:
      return "a uniform buffer";
    case gpu::BindingKind::StorageBuffer:
      return "a storage buffer";
    case gpu::BindingKind::UniformTexelBuffer:
      return "a texel buffer";
    case gpu::BindingKind::StorageTexelBuffer:
      return "a storage texel buffer";
    case gpu::BindingKind::SampledImage:
    case gpu::BindingKind::CombinedImageSampler:
      return "a sampled image";
    case gpu::BindingKind::StorageImage:
      return "a storage image";
    case gpu::BindingKind::Sampler:
      return "a sampler";
  }
  return "unknown";
}

// The usage that a port must declare for a shader to bind it in this way.
Usage requiredUsage(const gpu::ReflectedBinding& b) {
  switch (b.kind) {
    case gpu::BindingKind::UniformBuffer:
      return Usage::Uniform;
    case gpu::BindingKind::UniformTexelBuffer:
      return Usage::TexelRead;
    case gpu::BindingKind::SampledImage:
    case gpu::BindingKind::CombinedImageSampler:
      return Usage::Sampled;
    default:
      return Usage::StorageRead | Usage::StorageWrite;
  }
}

bool isImageBinding(gpu::BindingKind kind) {
  return kind == gpu::BindingKind::SampledImage || kind == gpu::BindingKind::CombinedImageSampler ||
         kind == gpu::BindingKind::StorageImage;
}

[[noreturn]] void bindingError(const PassInstance& pass, const std::string& shader,
                               const std::string& message, const std::string& remedy) {
  throw Error(ExitCode::BadInput,
              "pass `" + pass.bound->name + "` (" + pass.bound->declaration->type + "), shader " + shader +
                  ": " + message,
              remedy);
}

VkSampler samplerByName(gpu::Device& device, const std::string& name) {
  if (name == "linearClamp")
    return gpu::sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  if (name == "linearRepeat") return gpu::sampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  if (name == "nearestClamp")
    return gpu::sampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  if (name == "nearestRepeat") return gpu::sampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT);
  return VK_NULL_HANDLE;
}

KernelBinding resolvePort(PassInstance& pass, const std::string& shader, const gpu::ReflectedBinding& b,
                          uint32_t accessIndex) {
  const Access& access = pass.bound->accesses[accessIndex];
  const PortSpec& port = pass.bound->declaration->ports[access.port];
  const bool image = pass.desc(access).kind == ResourceKind::Image;
  if (image != isImageBinding(b.kind))
    bindingError(pass, shader,
                 "binding `" + b.name + "` is " + kindName(b.kind) + ", but port `" + port.name + "` is " +
                     (image ? "an image" : "a buffer"),
                 "make both the same kind");
  if (!any(access.usage, requiredUsage(b)))
    bindingError(pass, shader,
                 "binding `" + b.name + "` is " + kindName(b.kind) + ", a usage that port `" + port.name +
                     "` does not declare",
                 "add the usage to the port in the pass's declaration");
  if (b.kind == gpu::BindingKind::StorageImage && b.imageFormat && *b.imageFormat != VK_FORMAT_UNDEFINED &&
      *b.imageFormat != pass.desc(access).format)
    bindingError(pass, shader,
                 "storage image `" + b.name + "` has another format than port `" + port.name + "`",
                 "use the format of the declaration in the layout qualifier");
  KernelBinding binding;
  binding.source = KernelBinding::Source::Port;
  binding.reflected = b;
  binding.access = accessIndex;
  binding.layout = access.layout;
  binding.port = port.name;
  if (b.kind == gpu::BindingKind::CombinedImageSampler)
    binding.sampler =
        gpu::sampler(*pass.state->device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  return binding;
}

// A block without an instance name goes by the name of the block, which starts with a capital: `buffer Total {...};`.
std::string portSpelling(const std::string& binding) {
  std::string name = binding;
  if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

KernelBinding resolveBinding(PassInstance& pass, const std::string& shader, gpu::ReflectedBinding b) {
  b.name = portSpelling(b.name);
  if (auto it = pass.accessByShader.find(b.name); it != pass.accessByShader.end())
    return resolvePort(pass, shader, b, it->second);
  KernelBinding binding;
  binding.reflected = b;
  if (b.kind == gpu::BindingKind::Sampler) {
    binding.source = KernelBinding::Source::Sampler;
    binding.sampler = samplerByName(*pass.state->device, b.name);
    if (binding.sampler == VK_NULL_HANDLE)
      bindingError(pass, shader, "no sampler is called `" + b.name + "`",
                   "use linearClamp, linearRepeat, nearestClamp or nearestRepeat");
    return binding;
  }
  if (b.kind == gpu::BindingKind::StorageBuffer && b.name == "counters") {
    if (pass.bound->declaration->counters.empty())
      bindingError(pass, shader, "the shader counts, but the pass declares no counters",
                   "declare them with counter()");
    binding.source = KernelBinding::Source::Counters;
    return binding;
  }
  // Bound by hand in record(), for instance as an image view of one mip level; checked only
  // when the command is flushed.
  binding.source = KernelBinding::Source::Manual;
  if (b.kind == gpu::BindingKind::CombinedImageSampler)
    binding.sampler =
        gpu::sampler(*pass.state->device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  return binding;
}

KernelConstant resolveConstant(const PassInstance& pass, const gpu::ReflectedConstant& c) {
  KernelConstant constant;
  constant.reflected = c;
  if (c.name == "frameIndex") constant.source = KernelConstant::Source::FrameIndex;
  if (c.name == "seed") constant.source = KernelConstant::Source::Seed;
  const auto& specs = pass.bound->declaration->parameters;
  for (uint32_t i = 0; i < specs.size(); ++i) {
    if (shaderName(specs[i].name) != c.name || specs[i].type == ParameterSpec::Type::Text) continue;
    constant.source = KernelConstant::Source::Parameter;
    constant.parameter = i;
  }
  return constant;
}

KernelState& makeKernel(PassInstance& pass, std::string name, gpu::Pipeline pipeline) {
  KernelState& kernel = pass.kernels.emplace_back();
  kernel.pass = &pass;
  kernel.name = std::move(name);
  kernel.pipeline = std::move(pipeline);
  for (const gpu::ReflectedBinding& b : kernel.pipeline.interface().bindings)
    kernel.bindings.push_back(resolveBinding(pass, kernel.name, b));
  for (const gpu::ReflectedConstant& c : kernel.pipeline.interface().constants)
    kernel.constants.push_back(resolveConstant(pass, c));
  return kernel;
}

// A parameter as the 32-bit word that its constant expects; a choice is represented by its index.
uint32_t parameterWord(const PassInstance& pass, const KernelConstant& constant) {
  const ParameterSpec& spec = pass.bound->declaration->parameters[constant.parameter];
  const Parameters& p = pass.bound->parameters;
  if (constant.reflected.type == gpu::ReflectedConstant::Type::Float) {
    const float value = static_cast<float>(p.real(spec.name));
    uint32_t word;
    std::memcpy(&word, &value, sizeof(word));
    return word;
  }
  switch (spec.type) {
    case ParameterSpec::Type::Bool:
      return p.flag(spec.name) ? 1u : 0u;
    case ParameterSpec::Type::Int:
      return static_cast<uint32_t>(p.integer(spec.name));
    case ParameterSpec::Type::Choice: {
      const auto& choices = spec.choices;
      return static_cast<uint32_t>(std::find(choices.begin(), choices.end(), p.text(spec.name)) -
                                   choices.begin());
    }
    default:
      break;
  }
  throw Error(ExitCode::Internal, "pass `" + pass.bound->declaration->type + "`: push constant `" +
                                      constant.reflected.name + "` cannot hold parameter `" + spec.name +
                                      "`");
}

}  // namespace

Kernel PrepareContext::compute(const std::string& shader, gpu::Defines defines) {
  gpu::ComputePipelineDesc desc;
  desc.shader = device().shaders().compile(shader, defines);
  desc.sharedSet = pass_.state->sharedLayout;
  Kernel kernel;
  kernel.state_ = &makeKernel(pass_, shader, gpu::Pipeline(device(), desc));
  return kernel;
}

Kernel PrepareContext::graphics(const GraphicsKernelDesc& d) {
  gpu::GraphicsPipelineDesc desc;
  desc.vertex = device().shaders().compile(d.vertex, d.defines);
  if (!d.fragment.empty()) desc.fragment = device().shaders().compile(d.fragment, d.defines);
  desc.sharedSet = pass_.state->sharedLayout;
  for (const std::string& color : d.colors)
    desc.colorFormats.push_back(pass_.desc(pass_.access(color)).format);
  if (!d.depth.empty()) desc.depthFormat = pass_.desc(pass_.access(d.depth)).format;
  desc.topology = d.topology;
  desc.cull = d.cull;
  desc.depthTest = !d.depth.empty();
  desc.depthWrite = d.depthWrite && !d.depth.empty();
  desc.depthCompare = d.depthCompare;
  desc.additiveBlend = d.additiveBlend;
  desc.depthBiasConstant = d.depthBiasConstant;
  desc.depthBiasSlope = d.depthBiasSlope;
  Kernel kernel;
  const std::string name = d.fragment.empty() ? d.vertex : d.vertex + " + " + d.fragment;
  kernel.state_ = &makeKernel(pass_, name, gpu::Pipeline(device(), desc));
  return kernel;
}

Kernel PrepareContext::fullscreen(const std::string& fragment, const std::vector<std::string>& colors,
                                  gpu::Defines defines) {
  Kernel kernel = graphics({.vertex = "common/fullscreen.vert",
                            .fragment = fragment,
                            .defines = std::move(defines),
                            .colors = colors});
  for (const std::string& color : colors) kernel.state_->covers.push_back({color, Attachment::Load::Discard});
  return kernel;
}

// ---- Commands --------------------------------------------------------------------------------------------------

Commands::Commands(RecordContext& context, KernelState& kernel) : context_(context), kernel_(kernel) {
  for (size_t i = 0; i < kernel_.constants.size(); ++i) {
    const KernelConstant& c = kernel_.constants[i];
    uint32_t word = 0;
    switch (c.source) {
      case KernelConstant::Source::Manual:
        continue;
      case KernelConstant::Source::Parameter:
        word = parameterWord(context_.pass_, c);
        break;
      case KernelConstant::Source::FrameIndex:
        word = static_cast<uint32_t>(context_.frame_.index);
        break;
      case KernelConstant::Source::Seed:
        word = context_.frame_.seed;
        break;
    }
    std::memcpy(constants_ + c.reflected.offset, &word, sizeof(word));
    constantsSet_ |= uint64_t(1) << i;
  }
}

Commands& Commands::constantBytes(std::string_view name, const void* data, size_t bytes) {
  for (size_t i = 0; i < kernel_.constants.size(); ++i) {
    const gpu::ReflectedConstant& c = kernel_.constants[i].reflected;
    if (c.name != name) continue;
    if (bytes != c.bytes)
      throw Error(ExitCode::Internal, "shader " + kernel_.name + ": push constant `" + c.name + "` has " +
                                          std::to_string(c.bytes) + " bytes, not " + std::to_string(bytes));
    std::memcpy(constants_ + c.offset, data, bytes);
    constantsSet_ |= uint64_t(1) << i;
    return *this;
  }
  throw Error(ExitCode::Internal,
              "shader " + kernel_.name + " has no push constant `" + std::string(name) + "`");
}

static uint32_t bindingIndex(const KernelState& kernel, std::string_view name) {
  for (uint32_t i = 0; i < kernel.bindings.size(); ++i)
    if (kernel.bindings[i].reflected.name == name) return i;
  throw Error(ExitCode::Internal, "shader " + kernel.name + " has no binding `" + std::string(name) + "`");
}

Commands& Commands::bind(std::string_view name, VkImageView view) {
  kernel_.overrides.push_back({bindingIndex(kernel_, name), view, VK_NULL_HANDLE, 0, VK_WHOLE_SIZE});
  return *this;
}

Commands& Commands::bind(std::string_view name, const gpu::Buffer& buffer, uint64_t offset, uint64_t range) {
  kernel_.overrides.push_back({bindingIndex(kernel_, name), VK_NULL_HANDLE, buffer.handle(), offset, range});
  return *this;
}

Commands& Commands::range(std::string_view port, uint64_t offset, uint64_t bytes) {
  return bind(shaderName(port), context_.buffer(port), offset, bytes);
}

// One descriptor of set 0: a wired port, an override of this command, the counters or a sampler.
struct Descriptor {
  VkDescriptorImageInfo image{};
  VkDescriptorBufferInfo buffer{};
  VkBufferView texels = VK_NULL_HANDLE;
};

static void fillImage(const KernelBinding& b, VkImageView view, Descriptor& d) {
  const bool storage = b.reflected.kind == gpu::BindingKind::StorageImage;
  d.image = {b.sampler, view,
             b.layout != VK_IMAGE_LAYOUT_UNDEFINED ? b.layout
             : storage                             ? VK_IMAGE_LAYOUT_GENERAL
                                                   : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

// The texel format of a buffer: four components per texel if its stride is a multiple of 16 bytes, two if it is a
// multiple of 8, otherwise one.
static VkFormat texelFormat(uint32_t stride, bool integer) {
  if (stride % 16 == 0) return integer ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT;
  if (stride % 8 == 0) return integer ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32_SFLOAT;
  return integer ? VK_FORMAT_R32_UINT : VK_FORMAT_R32_SFLOAT;
}

static void fillPort(PassInstance& pass, const KernelBinding& b, Descriptor& d) {
  const Access& access = pass.bound->accesses[b.access];
  if (isImageBinding(b.reflected.kind)) {
    fillImage(b, pass.state->image(access).view(), d);
  } else if (b.reflected.kind == gpu::BindingKind::UniformTexelBuffer) {
    d.texels = pass.state->buffer(access).texelView(
        texelFormat(pass.desc(access).stride, b.reflected.integerTexels));
  } else {
    d.buffer = {pass.state->buffer(access).handle(), 0, VK_WHOLE_SIZE};
  }
}

static void fillDescriptor(PassInstance& pass, const KernelState& kernel, uint32_t index, Descriptor& d) {
  const KernelBinding& b = kernel.bindings[index];
  d.image.sampler = b.sampler;
  for (const KernelState::Override& o : kernel.overrides) {
    if (o.binding != index) continue;
    if (o.view)
      fillImage(b, o.view, d);
    else
      d.buffer = {o.buffer, o.offset, o.range};
    return;
  }
  switch (b.source) {
    case KernelBinding::Source::Sampler:
      return;
    case KernelBinding::Source::Port:
      fillPort(pass, b, d);
      return;
    case KernelBinding::Source::Counters:
      d.buffer = {pass.state->counters.handle(), pass.counterOffset,
                  pass.counterValues.size() * sizeof(uint32_t)};
      return;
    case KernelBinding::Source::Manual:
      break;
  }
  const std::string nearest = nearestName(b.reflected.name, pass.paths());
  bindingError(pass, kernel.name,
               "binding `" + b.reflected.name + "` is neither a wired port nor bound by hand",
               nearest.empty() ? "name it after a port" : "did you mean port `" + nearest + "`?");
}

void Commands::checkConstants() const {
  for (size_t i = 0; i < kernel_.constants.size(); ++i)
    if (!(constantsSet_ >> i & 1))
      throw Error(ExitCode::Internal, "pass `" + context_.pass_.bound->name + "`: push constant `" +
                                          kernel_.constants[i].reflected.name + "` of shader " +
                                          kernel_.name + " was not set");
}

void Commands::flush() {
  constexpr size_t kMaxBindings = 32;  // the number that every device with push descriptors supports
  const size_t count = kernel_.bindings.size();
  if (count > kMaxBindings)
    throw Error(ExitCode::Internal, "shader " + kernel_.name + " has more than 32 bindings in set 0");
  checkConstants();
  std::array<Descriptor, kMaxBindings> descriptors;
  std::array<VkWriteDescriptorSet, kMaxBindings> writes;
  for (uint32_t i = 0; i < count; ++i) {
    fillDescriptor(context_.pass_, kernel_, i, descriptors[i]);
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = kernel_.bindings[i].reflected.binding;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = gpu::descriptorType(kernel_.bindings[i].reflected.kind);
    writes[i].pImageInfo = &descriptors[i].image;
    writes[i].pBufferInfo = &descriptors[i].buffer;
    writes[i].pTexelBufferView = &descriptors[i].texels;
  }
  const gpu::Pipeline& p = kernel_.pipeline;
  ExecutorState& state = *context_.pass_.state;
  vkCmdBindPipeline(context_.cmd_, p.bindPoint(), p.handle());
  if (count)
    state.device->pushDescriptorSet(context_.cmd_, p.bindPoint(), p.layout(), 0, {writes.data(), count});
  if (p.interface().usesSharedSet)
    vkCmdBindDescriptorSets(context_.cmd_, p.bindPoint(), p.layout(), 1, 1, &state.sharedSet, 1,
                            &context_.pass_.viewOffset);
  if (p.interface().pushConstantBytes)
    vkCmdPushConstants(context_.cmd_, p.layout(), p.interface().stages, 0, p.interface().pushConstantBytes,
                       constants_);
}

void Commands::dispatch(uint32_t x, uint32_t y, uint32_t z) {
  flush();
  vkCmdDispatch(context_.cmd_, x, y, z);
}

void Commands::dispatchThreads(uint32_t x, uint32_t y, uint32_t z) {
  const auto& local = kernel_.pipeline.interface().localSize;
  dispatch((x + local[0] - 1) / local[0], (y + local[1] - 1) / local[1], (z + local[2] - 1) / local[2]);
}

void Commands::dispatchOver(std::string_view imagePort) {
  const ResourceDesc& d = context_.pass_.desc(context_.pass_.access(imagePort));
  dispatchThreads(d.width, d.height, std::max(d.depth, d.layers));
}

void Commands::dispatchIndirect(std::string_view bufferPort, uint64_t offset) {
  flush();
  vkCmdDispatchIndirect(context_.cmd_, context_.buffer(bufferPort).handle(), offset);
}

void Commands::drawFullscreen() {
  context_.render(kernel_.covers, nullptr, [&] { draw(3); });
}

void Commands::draw(uint32_t vertices, uint32_t instances, uint32_t firstInstance) {
  flush();
  vkCmdDraw(context_.cmd_, vertices, instances, 0, firstInstance);
}

void Commands::drawIndexed(VkBuffer indices32, uint32_t count, uint32_t first, uint32_t instances,
                           uint32_t firstInstance) {
  flush();
  vkCmdBindIndexBuffer(context_.cmd_, indices32, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(context_.cmd_, count, instances, first, 0, firstInstance);
}

void Commands::drawIndirect(std::string_view bufferPort, uint64_t offset, uint32_t count, uint32_t stride) {
  flush();
  vkCmdDrawIndirect(context_.cmd_, context_.buffer(bufferPort).handle(), offset, count, stride);
}

}  // namespace fovea::graph
