// Commands: one dispatch or draw, from its constants and bindings to the barrier before it.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "fovea/error.h"
#include "framework/gpu/shader/operations.h"
#include "framework/graph/run/execute_state.h"
#include "framework/scene/frame.h"

namespace fovea::graph {

namespace {

// A parameter as the 32-bit word that its constant expects; a choice is represented by its index.
uint32_t parameterWord(const PassInstance& pass, const KernelConstant& constant) {
  const ParameterSpec& spec = pass.bound->declaration->parameters[constant.parameter];
  const Parameters& p = pass.bound->parameters;
  if (constant.reflected.type == gpu::ReflectedMember::Type::Float)
    return std::bit_cast<uint32_t>(static_cast<float>(p.real(spec.name)));
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
  throw Error(ExitCode::Internal,
              "push constant `" + constant.reflected.name + "` cannot hold parameter `" + spec.name + "`");
}

}  // namespace

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
      case KernelConstant::Source::FoveaRadius:
        word = std::bit_cast<uint32_t>(context_.view().foveaRadius);
        break;
    }
    std::memcpy(constants_ + c.reflected.offset, &word, sizeof(word));
    constantsSet_ |= uint64_t(1) << i;
  }
}

Commands& Commands::constantBytes(std::string_view name, const void* data, size_t bytes) {
  for (size_t i = 0; i < kernel_.constants.size(); ++i) {
    const gpu::ReflectedMember& c = kernel_.constants[i].reflected;
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

Commands& Commands::mip(std::string_view name, std::string_view port, uint32_t level) {
  kernel_.overrides.push_back({bindingIndex(kernel_, name), accessOf(*context_.pass_.bound, port),
                               context_.image(port).mipView(level), VK_NULL_HANDLE, 0, VK_WHOLE_SIZE});
  return *this;
}

Commands& Commands::range(std::string_view port, uint64_t offset, uint64_t bytes) {
  kernel_.overrides.push_back({bindingIndex(kernel_, shaderName(port)), kNone, VK_NULL_HANDLE,
                               context_.buffer(port).handle(), offset, bytes});
  return *this;
}

Commands& Commands::together() {
  together_ = true;
  return *this;
}

// One descriptor of set 0: a wired port, an override of this command, the counters or a sampler.
struct Descriptor {
  VkDescriptorImageInfo image{};
  VkDescriptorBufferInfo buffer{};
  VkBufferView texels = VK_NULL_HANDLE;
};

static void fillImage(const KernelBinding& b, VkImageView view, VkImageLayout layout, Descriptor& d) {
  d.image = {b.sampler, view, layout};
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
    fillImage(b, pass.state->image(access).view(), access.layout, d);
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
      fillImage(b, o.view, pass.bound->accesses[o.access].layout, d);
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
    case KernelBinding::Source::Operations:
      d.buffer = {pass.state->counters.handle(), pass.operationsOffset, gpu::kOperationsBytes};
      return;
    case KernelBinding::Source::Manual:
      break;
  }
  const std::string nearest = nearestName(b.reflected.name, wiredPaths(*pass.bound));
  bindingError(pass, kernel.name,
               "binding `" + b.reflected.name + "` is neither a wired port nor bound by hand",
               nearest.empty() ? "name it after a port" : "did you mean port `" + nearest + "`?");
}

void Commands::checkConstants() const {
  for (size_t i = 0; i < kernel_.constants.size(); ++i)
    if (!(constantsSet_ >> i & 1))
      throw Error(ExitCode::Internal, "push constant `" + kernel_.constants[i].reflected.name +
                                          "` of shader " + kernel_.name + " was not set");
}

// Waits for what the command reads and writes. Inside a rendering, render() has already waited.
void Commands::begin(const uint32_t* indirect) {
  PassInstance& pass = context_.pass_;
  if (pass.rendering) {
    const bool known = std::any_of(pass.renderKernels.begin(), pass.renderKernels.end(),
                                   [&](const Kernel& kernel) { return kernel.state_ == &kernel_; });
    if (known) return;
    throw Error(ExitCode::Internal, "it draws with " + kernel_.name + ", which it did not name to render()");
  }
  std::vector<StepAccess>& touched = pass.touched;
  touched.assign(kernel_.accesses.begin(), kernel_.accesses.end());
  for (const KernelState::Override& o : kernel_.overrides)
    if (o.access != kNone)
      touched.push_back(
          bindingAccess(*pass.bound, o.access, kernel_.bindings[o.binding].reflected, stagesOf(kernel_)));
  if (indirect) touched.push_back(portAccess(*pass.bound, *indirect, Usage::Indirect, stagesOf(kernel_)));
  pass.beginCommand(context_.cmd_, kernel_.label, touched, together_);
}

void Commands::flush(const uint32_t* indirect) {
  constexpr size_t kMaxBindings = 32;  // the number that every device with push descriptors supports
  const size_t count = kernel_.bindings.size();
  if (count > kMaxBindings)
    throw Error(ExitCode::Internal, "shader " + kernel_.name + " has more than 32 bindings in set 0");
  checkConstants();
  begin(indirect);
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
  const gpu::Pipeline& p = *kernel_.pipeline;
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

// In place of the device.
void Commands::runOnHost(uint32_t x, uint32_t y, uint32_t z, const uint32_t* indirect, uint64_t offset) {
  PassInstance& pass = context_.pass_;
  checkConstants();
  pass.beginRow(context_.cmd_, kernel_.label);
  pass.host.run(pass, kernel_, {constants_, kernel_.pipeline->interface().pushConstantBytes}, {x, y, z},
                indirect ? std::optional(*indirect) : std::nullopt, offset, context_.cmd_);
}

void Commands::dispatch(uint32_t x, uint32_t y, uint32_t z) {
  if (kernel_.host) return runOnHost(x, y, z);
  flush();
  vkCmdDispatch(context_.cmd_, x, y, z);
  ++context_.pass_.commands.dispatches;
}

void Commands::dispatchThreads(uint32_t x, uint32_t y, uint32_t z) {
  const auto& local = kernel_.pipeline->interface().localSize;
  dispatch((x + local[0] - 1) / local[0], (y + local[1] - 1) / local[1], (z + local[2] - 1) / local[2]);
}

void Commands::dispatchOver(std::string_view port) {
  const ResourceDesc& d = context_.pass_.desc(context_.pass_.access(port));
  if (d.kind == ResourceKind::Buffer) return dispatchThreads(static_cast<uint32_t>(d.count));
  dispatchThreads(d.width, d.height, std::max(d.depth, d.layers));
}

void Commands::dispatchIndirect(std::string_view bufferPort, uint64_t offset) {
  const uint32_t access = accessOf(*context_.pass_.bound, bufferPort);
  if (kernel_.host) return runOnHost(0, 0, 0, &access, offset);
  flush(&access);
  vkCmdDispatchIndirect(context_.cmd_, context_.buffer(bufferPort).handle(), offset);
  ++context_.pass_.commands.indirectDispatches;
}

void Commands::drawFullscreen() {
  Kernel kernel;
  kernel.state_ = &kernel_;
  context_.render(kernel_.covers, nullptr, {&kernel, 1}, [&] {
    const VkViewport tiled{0, 0, float(kernel_.tiled.width), float(kernel_.tiled.height), 0, 1};
    if (tiled.width > 0) vkCmdSetViewport(context_.cmd_, 0, 1, &tiled);
    draw(kernel_.vertices);
  });
}

namespace {

struct Instances {
  uint32_t count = 0, first = 0;
};

// The instances of a draw that go into the layer being rendered: all of them, unless layers take turns.
Instances inLayer(uint32_t layer, Instances all) {
  if (layer == kNone) return all;
  return {layer >= all.first && layer - all.first < all.count ? 1u : 0u, layer};
}

}  // namespace

void Commands::draw(uint32_t vertices, uint32_t instances, uint32_t firstInstance) {
  flush();
  ++context_.pass_.commands.draws;
  const Instances drawn = inLayer(context_.pass_.layer, {instances, firstInstance});
  vkCmdDraw(context_.cmd_, vertices, drawn.count, 0, drawn.first);
}

void Commands::drawTriangles(VkBuffer indices, uint32_t first, uint32_t count, uint32_t instances) {
  const std::string_view constant = "firstTriangle";
  for (const KernelConstant& c : kernel_.constants)
    if (c.reflected.name == constant) this->constant(constant, first);
  flush();
  ++context_.pass_.commands.draws;
  const Instances drawn = inLayer(context_.pass_.layer, {instances, 0});
  if (!context_.device().features().geometryShader)
    return vkCmdDraw(context_.cmd_, 3 * count, drawn.count, 3 * first, drawn.first);
  vkCmdBindIndexBuffer(context_.cmd_, indices, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(context_.cmd_, 3 * count, drawn.count, 3 * first, 0, drawn.first);
}

void Commands::drawIndirect(std::string_view bufferPort, uint64_t offset, uint32_t count, uint32_t stride) {
  if (context_.pass_.layer != kNone)
    throw Error(ExitCode::NoDevice,
                "it draws indirectly into layers, for which the device lacks shaderOutputLayer");
  const uint32_t access = accessOf(*context_.pass_.bound, bufferPort);
  flush(&access);
  ++context_.pass_.commands.draws;
  vkCmdDrawIndirect(context_.cmd_, context_.buffer(bufferPort).handle(), offset, count, stride);
}

}  // namespace fovea::graph
