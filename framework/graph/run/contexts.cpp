// The contexts through which passes see the graph, with resources and commands looked up by name.
#include <algorithm>
#include <cstring>
#include <tuple>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/gpu/format.h"
#include "framework/graph/run/execute_state.h"
#include "framework/scene/frame.h"

namespace fovea::graph {

PassInstance::PassInstance(ExecutorState& executorState, uint32_t passIndex,
                           std::unique_ptr<Pass> implementation)
    : state(&executorState),
      bound(&executorState.plan->graph->passes[passIndex]),
      index(passIndex),
      pass(std::move(implementation)),
      tracker(*bound) {
  const auto& counters = bound->declaration->counters;
  for (uint32_t i = 0; i < counters.size(); ++i) counterByName.emplace(counters[i].name, i);
  counterValues.resize(counters.size());
  counterSet.resize(counters.size());
  transferLabels.resize(bound->accesses.size(), {kNone, kNone, kNone});
}

const Access& PassInstance::access(std::string_view path) const {
  return bound->accesses[accessOf(*bound, path)];
}

Label PassInstance::label(std::string_view name) {
  for (Label i = 0; i < labels.size(); ++i)
    if (labels[i] == name) return i;
  labels.emplace_back(name);
  return static_cast<Label>(labels.size() - 1);
}

void PassInstance::beginRow(VkCommandBuffer cmd, Label of) {
  if (begun.empty()) throw Error(ExitCode::Internal, "a command outside of a pass");
  if (begun.size() == 1 && begun.back().label == kNone) begun.back().label = of;
  if (begun.back().label != of && state->stepTimestamps > 0) {
    --state->stepTimestamps;
    begun.push_back({of, writeTimestamp(*state, cmd)});
  }
}

void PassInstance::beginCommand(VkCommandBuffer cmd, Label of, std::span<const StepAccess> accesses,
                                bool together) {
  beginRow(cmd, of);
  if (host.bringToDevice(*this, cmd)) tracker.reset();
  host.note(accesses);
  if (const Dependency wait = tracker.before(accesses, together)) {
    gpu::memoryBarrier(cmd, wait.srcStage, wait.srcAccess, wait.dstStage, wait.dstAccess);
    ++commands.barriers;
  }
}

// Lavapipe takes a timestamp at the next flush but executes dispatches at once. Without a flush in between (an empty
// barrier causes one), commands that only dispatch would appear to start after their own work.
uint32_t writeTimestamp(ExecutorState& state, VkCommandBuffer cmd) {
  const uint32_t index = state.timestamps->write(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  if (!state.device->isCpu()) return index;
  const VkDependencyInfo nothing{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  vkCmdPipelineBarrier2(cmd, &nothing);
  return index;
}

// ---- RecordContext ---------------------------------------------------------------------------------------------

RecordContext::RecordContext(PassInstance& pass, VkCommandBuffer cmd, const scene::Frame& frame,
                             uint64_t frameNumber)
    : PassContext(*pass.state->plan->graph, *pass.bound),
      pass_(pass),
      cmd_(cmd),
      frame_(frame),
      frameNumber_(frameNumber) {}

gpu::Device& RecordContext::device() const { return *pass_.state->device; }
const scene::View& RecordContext::view() const { return frame_.views[pass_.viewIndex]; }
bool RecordContext::firstFrame() const { return pass_.firstFrame(); }
std::any& RecordContext::remembered() { return pass_.memory; }
static std::string quoted(std::string_view name) { return "`" + std::string(name) + "`"; }

static void requireKind(const PassInstance& pass, const Access& access, std::string_view port,
                        ResourceKind kind) {
  if (pass.desc(access).kind == kind) return;
  throw Error(ExitCode::Internal, "it takes " + quoted(port) + " for " +
                                      (kind == ResourceKind::Image ? "an image, but it is a buffer"
                                                                   : "a buffer, but it is an image"));
}

gpu::Image& RecordContext::image(std::string_view port) const {
  const Access& access = pass_.access(port);
  requireKind(pass_, access, port, ResourceKind::Image);
  return pass_.state->image(access);
}
gpu::Buffer& RecordContext::buffer(std::string_view port) const {
  const Access& access = pass_.access(port);
  requireKind(pass_, access, port, ResourceKind::Buffer);
  return pass_.state->buffer(access);
}

// ---- Steps and kernels -----------------------------------------------------------------------------------------

static uint32_t stepIndex(const PassInstance& pass, std::string_view name) {
  if (const auto found = pass.stepByName.find(name); found != pass.stepByName.end()) return found->second;
  throw Error(ExitCode::Internal, "it declares no step `" + std::string(name) + "`");
}

Commands RecordContext::step(std::string_view name) {
  const uint32_t index = stepIndex(pass_, name);
  if (index == kNone || !pass_.steps[index].kernel)
    throw Error(ExitCode::Internal,
                "it runs step `" + std::string(name) + "`, which has no kernel in this plan",
                "ask for the same condition as the declaration");
  return start(index);
}

Commands RecordContext::start(uint32_t index) {
  StepInstance& step = pass_.steps[index];
  step.kernel->overrides.clear();
  Commands commands(*this, *step.kernel);
  for (const auto& [name, word] : step.constants) commands.constant(name, word);
  for (const auto& set : step.spec->frameConstants) set(*this, commands);
  if (step.spec->together) commands.together();
  return commands;
}

void RecordContext::run(std::string_view name) {
  if (const uint32_t index = stepIndex(pass_, name); index != kNone) runStep(index);
}

void RecordContext::runSteps() {
  for (uint32_t i = 0; i < pass_.steps.size(); ++i) runStep(i);
}

void RecordContext::runStep(uint32_t index) {
  const StepInstance& step = pass_.steps[index];
  const StepSpec& spec = *step.spec;
  const auto [x, y, z] = step.size;
  VkClearColorValue color{};
  switch (spec.action) {
    case StepSpec::Action::Fill:
      return fill(spec.targets[0], spec.word);
    case StepSpec::Action::Clear:
      std::fill(std::begin(color.uint32), std::end(color.uint32), spec.word);
      return clear(spec.targets[0], color);
    case StepSpec::Action::Copy:
      return copy(spec.source, spec.targets[0]);
    case StepSpec::Action::Fullscreen:
      return start(index).drawFullscreen();
    case StepSpec::Action::Dispatch:
      break;
  }
  switch (spec.sizing) {
    case StepSpec::Size::Groups:
      return start(index).dispatch(x, y, z);
    case StepSpec::Size::Threads:
      return start(index).dispatchThreads(x, y, z);
    case StepSpec::Size::Over:
      return start(index).dispatchOver(spec.sizePort);
    case StepSpec::Size::Indirect:
      return start(index).dispatchIndirect(spec.sizePort, spec.offset);
    case StepSpec::Size::Manual:
      break;
  }
  throw Error(ExitCode::Internal,
              "step `" + spec.name + "` of pass type `" + pass_.bound->declaration->type + "` has no size");
}

Commands RecordContext::use(Kernel kernel) {
  if (!kernel.state_)
    throw Error(ExitCode::Internal, "it uses a kernel that was never made", "make it in prepare()");
  kernel.state_->overrides.clear();
  return Commands(*this, *kernel.state_);
}

void RecordContext::render(const std::vector<Attachment>& colors, const Attachment* depth,
                           std::span<const Kernel> kernels, const std::function<void()>& body,
                           uint32_t layers) {
  const VkExtent3D e = extent(colors.empty() ? depth->port : colors.front().port);
  render(colors, depth, kernels, VkRect2D{{0, 0}, {e.width, e.height}}, body, layers);
}

static VkRenderingAttachmentInfo attachmentInfo(const PassInstance& pass, const Attachment& a) {
  const Access& access = pass.access(a.port);
  gpu::Image& image = pass.state->image(access);
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = pass.layer == kNone ? image.view() : image.layerView(0, pass.layer);
  info.imageLayout = access.layout;
  info.loadOp = a.load == Attachment::Load::Clear  ? VK_ATTACHMENT_LOAD_OP_CLEAR
                : a.load == Attachment::Load::Keep ? VK_ATTACHMENT_LOAD_OP_LOAD
                                                   : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  info.clearValue = a.clear;
  return info;
}

static void beginRendering(PassInstance& pass, VkCommandBuffer cmd, const std::vector<Attachment>& colors,
                           const Attachment* depth, VkRect2D area, uint32_t layers) {
  std::vector<VkRenderingAttachmentInfo> colorInfos;
  for (const Attachment& a : colors) colorInfos.push_back(attachmentInfo(pass, a));
  VkRenderingAttachmentInfo depthInfo{};
  if (depth) depthInfo = attachmentInfo(pass, *depth);
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = area;
  info.layerCount = layers;
  info.colorAttachmentCount = static_cast<uint32_t>(colorInfos.size());
  info.pColorAttachments = colorInfos.data();
  info.pDepthAttachment = depth ? &depthInfo : nullptr;
  vkCmdBeginRendering(cmd, &info);
  ++pass.commands.renderings;
}

void RecordContext::render(const std::vector<Attachment>& colors, const Attachment* depth,
                           std::span<const Kernel> kernels, VkRect2D area, const std::function<void()>& body,
                           uint32_t layers) {
  std::vector<StepAccess>& touched = pass_.touched;
  touched.clear();
  const auto attach = [&](const Attachment& a, Usage usage) {
    touched.push_back(portAccess(*pass_.bound, accessOf(*pass_.bound, a.port), usage, PassKind::Graphics));
  };
  for (const Attachment& a : colors) attach(a, Usage::ColorAttachment);
  if (depth) attach(*depth, Usage::DepthAttachment);
  for (const Kernel& kernel : kernels)
    touched.insert(touched.end(), kernel.state_->accesses.begin(), kernel.state_->accesses.end());
  pass_.beginCommand(cmd_, kernels.empty() ? pass_.label("clear") : kernels.front().state_->label, touched);
  const VkViewport viewport{float(area.offset.x),
                            float(area.offset.y),
                            float(area.extent.width),
                            float(area.extent.height),
                            0.0f,
                            1.0f};
  vkCmdSetViewport(cmd_, 0, 1, &viewport);
  vkCmdSetScissor(cmd_, 0, 1, &area);
  pass_.rendering = true;
  pass_.renderKernels = kernels;
  const bool turns = layers > 1 && !device().features().shaderOutputLayer;
  for (uint32_t layer = 0; layer < (turns ? layers : 1); ++layer) {
    pass_.layer = turns ? layer : kNone;
    beginRendering(pass_, cmd_, colors, depth, area, turns ? 1 : layers);
    body();
    vkCmdEndRendering(cmd_);
  }
  pass_.layer = kNone;
  pass_.rendering = false;
}

// `act()` is what the pass does; the text is only put together for a message.
template <class Act>
static void requireTransfer(const PassInstance& pass, const Access& access, std::string_view port,
                            ResourceKind kind, Usage usage, const Act& act) {
  requireKind(pass, access, port, kind);
  if (any(access.usage, usage)) return;
  const char* name = usage == Usage::TransferRead ? "TransferRead" : "TransferWrite";
  throw Error(ExitCode::Internal,
              "it " + act() + " without declaring Usage::" + name + " on " + quoted(port));
}

namespace {

struct TransferAccess {
  const Access* access;
  Usage usage;
};

}  // namespace

// The label of a transfer names its first port; it is made once, in the first frame.
static void beginTransfer(PassInstance& pass, VkCommandBuffer cmd, Transfer kind,
                          std::initializer_list<TransferAccess> accesses) {
  pass.touched.clear();
  for (const TransferAccess& a : accesses)
    pass.touched.push_back(portAccess(*pass.bound,
                                      static_cast<uint32_t>(a.access - pass.bound->accesses.data()), a.usage,
                                      PassKind::Compute));
  Label& label = pass.transferLabels[pass.touched.front().access][static_cast<size_t>(kind)];
  if (label == kNone) {
    const Access& first = *accesses.begin()->access;
    const PortSpec& port = pass.bound->declaration->ports[first.port];
    constexpr const char* kVerbs[] = {"fill ", "clear ", "copy "};
    label = pass.label(kVerbs[static_cast<size_t>(kind)] + memberPath(port, port.members[first.member]));
  }
  pass.beginCommand(cmd, label, pass.touched);
  ++pass.commands.transfers;
}

void RecordContext::fill(std::string_view bufferPort, uint32_t word) {
  const Access& access = pass_.access(bufferPort);
  requireTransfer(pass_, access, bufferPort, ResourceKind::Buffer, Usage::TransferWrite,
                  [&] { return "fills " + quoted(bufferPort); });
  beginTransfer(pass_, cmd_, Transfer::Fill, {{&access, Usage::TransferWrite}});
  vkCmdFillBuffer(cmd_, pass_.state->buffer(access).handle(), 0, VK_WHOLE_SIZE, word);
}

void RecordContext::clear(std::string_view imagePort, VkClearColorValue value) {
  const Access& access = pass_.access(imagePort);
  requireTransfer(pass_, access, imagePort, ResourceKind::Image, Usage::TransferWrite,
                  [&] { return "clears " + quoted(imagePort); });
  gpu::Image& target = pass_.state->image(access);
  const VkImageSubresourceRange range = wholeImage(target);
  beginTransfer(pass_, cmd_, Transfer::Clear, {{&access, Usage::TransferWrite}});
  vkCmdClearColorImage(cmd_, target.handle(), access.layout, &value, 1, &range);
}

static std::string sizeText(const ResourceDesc& d) {
  std::string text = std::to_string(d.width) + "x" + std::to_string(d.height);
  if (d.depth > 1) text += "x" + std::to_string(d.depth);
  if (d.layers > 1) text += ", " + std::to_string(d.layers) + " layers";
  if (d.mips > 1) text += ", " + std::to_string(d.mips) + " mips";
  return text + ", " + std::string(gpu::formatInfo(d.format).name);
}

void RecordContext::copy(std::string_view imageFrom, std::string_view imageTo) {
  const Access &from = pass_.access(imageFrom), &to = pass_.access(imageTo);
  const auto act = [&] { return "copies " + quoted(imageFrom) + " to " + quoted(imageTo); };
  requireTransfer(pass_, from, imageFrom, ResourceKind::Image, Usage::TransferRead, act);
  requireTransfer(pass_, to, imageTo, ResourceKind::Image, Usage::TransferWrite, act);
  const ResourceDesc &source = pass_.desc(from), &d = pass_.desc(to);
  if (std::tie(source.width, source.height, source.depth, source.layers, source.format) !=
          std::tie(d.width, d.height, d.depth, d.layers, d.format) ||
      source.mips > 1 || d.mips > 1)
    throw Error(ExitCode::BadInput,
                "it " + act() + ", but " + quoted(imageFrom) + " is " + sizeText(source) + " and " +
                    quoted(imageTo) + " is " + sizeText(d),
                "wire images of one size and format, without mips");
  beginTransfer(pass_, cmd_, Transfer::Copy, {{&from, Usage::TransferRead}, {&to, Usage::TransferWrite}});
  const VkImageSubresourceLayers layers{wholeImage(pass_.state->image(from)).aspectMask, 0, 0, d.layers};
  const VkImageCopy region{layers, {0, 0, 0}, layers, {0, 0, 0}, {d.width, d.height, d.depth}};
  vkCmdCopyImage(cmd_, pass_.state->image(from).handle(), from.layout, pass_.state->image(to).handle(),
                 to.layout, 1, &region);
}

void RecordContext::barrier() {
  pass_.tracker.reset();
  ++pass_.commands.barriers;
  constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  gpu::memoryBarrier(cmd_, kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, kAll,
                     VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

static void setCounter(PassInstance& pass, std::string_view name, double value) {
  auto it = pass.counterByName.find(name);
  if (it == pass.counterByName.end())
    throw Error(ExitCode::Internal, "it has no counter `" + std::string(name) + "`");
  pass.counterValues[it->second] = value;
  pass.counterSet[it->second] = true;
}

void RecordContext::counter(std::string_view name, double value) { setCounter(pass_, name, value); }

// ---- HostContext -----------------------------------------------------------------------------------------------

HostContext::HostContext(PassInstance& pass, const scene::Frame& frame, uint64_t frameNumber)
    : PassContext(*pass.state->plan->graph, *pass.bound),
      pass_(pass),
      frame_(frame),
      frameNumber_(frameNumber) {}

const scene::View& HostContext::view() const { return frame_.views[pass_.viewIndex]; }
bool HostContext::firstFrame() const { return pass_.firstFrame(); }

static std::span<std::byte> stagingOf(PassInstance& pass, std::string_view port) {
  const Access& access = pass.access(port);
  HostStaging& staging = pass.staging.at(&access - pass.bound->accesses.data());
  return {static_cast<std::byte*>(staging.slots[pass.state->slot].mapped()),
          resourceBytes(pass.desc(access))};
}

std::span<const std::byte> HostContext::input(std::string_view port) const { return stagingOf(pass_, port); }
std::span<std::byte> HostContext::output(std::string_view port) const { return stagingOf(pass_, port); }
void HostContext::counter(std::string_view name, double value) { setCounter(pass_, name, value); }

bool HostContext::progress(double share) const {
  const HostProgress& report = pass_.state->hostProgress;
  return !report || report(pass_.bound->name, share);
}

}  // namespace fovea::graph
