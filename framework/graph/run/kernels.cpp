// Kernels: pipelines whose bindings are found by name.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <filesystem>
#include <limits>
#include <set>

#include "fovea/error.h"
#include "framework/gpu/shader/operations.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/run/execute_state.h"

namespace fovea::graph {

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

PassKind stagesOf(const KernelState& kernel) {
  return kernel.pipeline->bindPoint() == VK_PIPELINE_BIND_POINT_COMPUTE ? PassKind::Compute
                                                                        : PassKind::Graphics;
}

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
    case gpu::BindingKind::AccelerationStructure:
      return "an acceleration structure";
  }
  return "unknown";
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
  const bool insteadOfTexels = b.kind == gpu::BindingKind::StorageBuffer && b.readOnly &&
                               pass.state->device->lacks("maxTexelBufferElements");
  if (!any(access.usage, usageOf(b.kind)) && !(insteadOfTexels && any(access.usage, Usage::TexelRead)))
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
  binding.port = port.name;
  if (b.kind == gpu::BindingKind::CombinedImageSampler)
    binding.sampler =
        gpu::sampler(*pass.state->device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  return binding;
}

KernelBinding resolveBinding(PassInstance& pass, const std::string& shader, gpu::ReflectedBinding b) {
  b.name = bindingName(b.name);
  if (const uint32_t access = accessOfBinding(*pass.bound, b.name); access != kNone)
    return resolvePort(pass, shader, b, access);
  KernelBinding binding;
  binding.reflected = b;
  if (b.name == gpu::kOperationsBinding) {
    binding.source = KernelBinding::Source::Operations;
    return binding;
  }
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

KernelConstant resolveConstant(const PassInstance& pass, const gpu::ReflectedMember& c) {
  KernelConstant constant;
  constant.reflected = c;
  if (c.name == "frameIndex") constant.source = KernelConstant::Source::FrameIndex;
  if (c.name == "seed") constant.source = KernelConstant::Source::Seed;
  if (c.name == "foveaRadius") constant.source = KernelConstant::Source::FoveaRadius;
  const auto& specs = pass.bound->declaration->parameters;
  for (uint32_t i = 0; i < specs.size(); ++i) {
    if (shaderName(specs[i].name) != c.name || specs[i].type == ParameterSpec::Type::Text) continue;
    constant.source = KernelConstant::Source::Parameter;
    constant.parameter = i;
  }
  return constant;
}

// "blur/rows.comp" -> "rows"
std::string stemOf(const std::string& shader) { return std::filesystem::path(shader).stem().string(); }

// A pipeline of the executor before this one, or a new one. A key names all that a pipeline is made of.
template <class Desc>
void choosePipeline(const ExecutorState& state, KernelState& kernel, std::string key, const Desc& desc) {
  const auto known = state.pipelines.find(key);
  kernel.pipeline =
      known != state.pipelines.end() ? known->second : std::make_shared<gpu::Pipeline>(*state.device, desc);
  kernel.key = std::move(key);
}

std::string keyOf(const gpu::ComputePipelineDesc& desc) {
  return fmt::format("{:016x}{}", desc.shader->hash, desc.onlyInterface ? " on the host" : "");
}

std::string keyOf(const gpu::GraphicsPipelineDesc& d) {
  std::string key = fmt::format("{:016x} {:016x} {} {} {} {} {} {} {} {} {} {}", d.vertex->hash,
                                d.fragment ? d.fragment->hash : 0, int(d.depthFormat), int(d.topology),
                                uint32_t(d.cull), d.depthTest, d.depthWrite, int(d.depthCompare),
                                d.additiveBlend, d.depthBiasConstant, d.depthBiasSlope, d.clipDistances);
  for (const VkFormat format : d.colorFormats) key += fmt::format(" {}", int(format));
  return key;
}

// Rays would hit nothing, as the scene builds its bounding volume hierarchies on the device only if a pass asks for
// them.
void checkRays(const PassInstance& pass, const gpu::CompiledShader& shader, const std::string& name) {
  if (!pass.bound->declaration->tracesRays && tracesRays(shader))
    bindingError(pass, name, "it traces rays, which the pass does not declare",
                 "write `\"rays\": true` in the pass's file, or `declaration.rays()`");
}

template <class Desc>
KernelState& makeKernel(PassInstance& pass, std::string name, const std::string& label, const Desc& desc) {
  KernelState& kernel = pass.kernels.emplace_back();
  kernel.pass = &pass;
  kernel.name = std::move(name);
  kernel.label = pass.label(label);
  choosePipeline(*pass.state, kernel, keyOf(desc), desc);
  for (const gpu::ReflectedBinding& b : kernel.pipeline->interface().bindings)
    kernel.bindings.push_back(resolveBinding(pass, kernel.name, b));
  for (const gpu::ReflectedMember& c : kernel.pipeline->interface().constants)
    kernel.constants.push_back(resolveConstant(pass, c));
  kernel.accesses = shaderAccesses(*pass.bound, kernel.pipeline->interface().bindings, stagesOf(kernel));
  return kernel;
}

}  // namespace

Kernel& Kernel::called(const std::string& row) {
  state_->label = state_->pass->label(row);
  return *this;
}

PrepareContext::PrepareContext(PassInstance& pass)
    : PassContext(*pass.state->plan->graph, *pass.bound), pass_(pass) {}

gpu::Device& PrepareContext::device() const { return *pass_.state->device; }

Kernel PrepareContext::compute(const std::string& shader, gpu::Defines defines) {
  return compute(shader, defines, false);
}

Kernel PrepareContext::compute(const std::string& shader, const gpu::Defines& defines, bool onHost) {
  gpu::ComputePipelineDesc desc;
  desc.onlyInterface = onHost;
  desc.shader = device().shaders().compile(shader, defines);
  checkRays(pass_, *desc.shader, shader);
  if (pass_.state->countOperations && !onHost) desc.shader = gpu::countingShader(*desc.shader);
  desc.sharedSet = pass_.state->sharedLayout;
  Kernel kernel;
  kernel.state_ = &makeKernel(pass_, shader, stemOf(shader), desc);
  return kernel;
}

Kernel PrepareContext::graphics(const GraphicsKernelDesc& d) {
  gpu::GraphicsPipelineDesc desc;
  desc.vertex = device().shaders().compile(d.vertex, d.defines);
  if (!d.fragment.empty()) desc.fragment = device().shaders().compile(d.fragment, d.defines);
  checkRays(pass_, *desc.vertex, d.vertex);
  if (desc.fragment) checkRays(pass_, *desc.fragment, d.fragment);
  if (pass_.state->countOperations) {
    desc.vertex = gpu::countingShader(*desc.vertex);
    if (desc.fragment) desc.fragment = gpu::countingShader(*desc.fragment);
  }
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
  kernel.state_ = &makeKernel(pass_, name, stemOf(d.fragment.empty() ? d.vertex : d.fragment), desc);
  return kernel;
}

Kernel PrepareContext::fullscreen(const std::string& fragment, const std::vector<std::string>& colors,
                                  gpu::Defines defines) {
  Kernel kernel = graphics({.vertex = "device/fullscreen.vert",
                            .fragment = fragment,
                            .defines = std::move(defines),
                            .colors = colors});
  for (const std::string& color : colors) kernel.state_->covers.push_back({color, Attachment::Load::Discard});
  return kernel;
}

namespace {

// Sizes and push constants have 32 bits.
uint32_t stepWord(const PassInstance& pass, const StepSpec& spec, int64_t value, const SizeExpr& expression) {
  if (value >= 0 && value <= std::numeric_limits<uint32_t>::max()) return static_cast<uint32_t>(value);
  throw Error(ExitCode::BadInput, "pass `" + pass.bound->name + "` (" + pass.bound->declaration->type +
                                      "), step `" + spec.name + "`: `" + expression.print() + "` is " +
                                      std::to_string(value) +
                                      ", which no 32-bit number without a sign holds");
}

// Pixels along an axis that whole tiles span; 0 if no power of two is the width of that many tiles.
uint32_t tileSpan(uint32_t pixels, uint32_t tiles) {
  const uint32_t width = std::bit_ceil((pixels + tiles - 1) / tiles);
  return (pixels + width - 1) / width == tiles ? tiles * width : 0;
}

// Lets a full-screen kernel draw only the tiles of a mask. written: what earlier steps have written.
void drawTiles(const PassInstance& pass, const StepSpec& spec, const VkExtent3D& image,
               const VkExtent3D& mask, const std::set<std::string>& written, KernelState& kernel) {
  kernel.tiled = {tileSpan(image.width, mask.width), tileSpan(image.height, mask.height)};
  if (kernel.tiled.width == 0 || kernel.tiled.height == 0)
    throw Error(
        ExitCode::BadInput,
        fmt::format("pass `{}` ({}), step `{}`: `{}` has {}x{} texels for images of {}x{}, so its tiles are "
                    "not a power of two wide and high",
                    pass.bound->name, pass.bound->declaration->type, spec.name, spec.tileMask, mask.width,
                    mask.height, image.width, image.height),
        "make it as large as the images divided by 8, 16 or 32");
  kernel.vertices = 6 * mask.width * mask.height;
  for (Attachment& cover : kernel.covers)
    cover.load = written.contains(cover.port) ? Attachment::Load::Keep : Attachment::Load::Clear;
}

// Its row in the timings.
void labelStep(PassInstance& pass, const StepInstance& step) {
  const Label label = pass.label(step.spec->name);
  if (step.kernel) {
    step.kernel->label = label;
    return;
  }
  const StepSpec& spec = *step.spec;
  const bool copy = spec.action == StepSpec::Action::Copy;
  const auto kind = copy                                     ? Transfer::Copy
                    : spec.action == StepSpec::Action::Clear ? Transfer::Clear
                                                             : Transfer::Fill;
  const uint32_t access = accessOf(*pass.bound, copy ? spec.source : spec.targets[0]);
  pass.transferLabels[access][static_cast<size_t>(kind)] = label;
}

}  // namespace

void buildSteps(PassInstance& pass, const std::vector<PlannedStep>& planned) {
  PrepareContext context(pass);
  const std::vector<StepSpec>& specs = pass.bound->declaration->steps;
  for (const StepSpec& spec : specs) pass.stepByName.emplace(spec.name, kNone);
  std::set<std::string> written;
  for (const PlannedStep& plan : planned) {
    const StepSpec& spec = specs[plan.step];
    StepInstance step{&plan, &spec, nullptr, {}, {}};
    const auto word = [&](const SizeExpr& value) {
      return stepWord(pass, spec, context.evaluate(value), value);
    };
    for (size_t i = 0; i < step.size.size(); ++i) step.size[i] = word(spec.size[i]);
    for (const auto& [name, value] : spec.constants) step.constants.emplace_back(name, word(value));
    Kernel kernel;
    if (spec.action == StepSpec::Action::Dispatch)
      kernel = context.compute(spec.shader, stepDefines(spec, context), bool(plan.host));
    if (spec.action == StepSpec::Action::Fullscreen)
      kernel = context.fullscreen(spec.shader, spec.targets, stepDefines(spec, context));
    if (context.has(spec.tileMask))
      drawTiles(pass, spec, context.extent(spec.targets[0]), context.extent(spec.tileMask), written,
                *kernel.state_);
    written.insert(spec.targets.begin(), spec.targets.end());
    step.kernel = kernel.state_;
    if (step.kernel) step.kernel->host = plan.host;
    labelStep(pass, step);
    pass.stepByName[spec.name] = static_cast<uint32_t>(pass.steps.size());
    pass.steps.push_back(std::move(step));
  }
  pass.host.prepare(pass);
}

}  // namespace fovea::graph
