// The frame loop: barriers of the plan, commands of the passes, timestamps, and staging for host passes.
#include "framework/graph/run/execute.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "fovea/error.h"
#include "framework/base/paths.h"
#include "framework/gpu/barrier.h"
#include "framework/gpu/shader/operations.h"
#include "framework/gpu/timestamps.h"
#include "framework/graph/pass/guard.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/run/frame_slot.h"
#include "framework/graph/run/light_units.h"
#include "framework/graph/steps/steps.h"
#include "framework/scene/frame.h"

namespace fovea::graph {

// Boundaries between steps that a frame can time; the time of further steps counts for the one before.
constexpr uint32_t kStepTimestamps = 2048;

struct Executor::Impl {
  gpu::Device& device;
  std::shared_ptr<const Plan> plan;
  scene::FrameDescriptors& descriptors;
  ExecutorOptions options;
  ExecutorState state;
  PassInstances passes;  // the live passes in order of execution
  std::deque<FrameSlot> slots;
  std::deque<uint32_t> inFlight;  // slots, oldest first
  std::deque<FrameResult> finished;
  uint64_t frameCount = 0;
  uint64_t residentAtStart = 0;
  std::optional<Clock::time_point> lastFinish;
  VkCommandBuffer cmd = VK_NULL_HANDLE;
  uint32_t segment = 0;
  std::vector<VkImageMemoryBarrier2> imageBarriers;  // of one batch

  Impl(gpu::Device& d, std::shared_ptr<const Plan> p, scene::FrameDescriptors& s, const ExecutorOptions& o)
      : device(d), plan(std::move(p)), descriptors(s), options(o) {}
  ~Impl();

  void build(const Registry& registry, Impl* before);
  void buildPasses(const Registry& registry);
  void buildStaging(PassInstance& pass);
  void takeOver(Impl& before);

  void beginSegment(FrameSlot& slot);
  void submitSegment(FrameSlot& slot, bool last);
  void emitBarriers(const BarrierBatch& batch);
  void runPass(FrameSlot& slot, PassInstance& pass, const scene::Frame& frame, RecordedPass& recorded);
  // Milliseconds spent waiting for the device; nullopt if the pass reads nothing that the device wrote.
  std::optional<double> runHostPass(FrameSlot& slot, PassInstance& pass, const scene::Frame& frame);
  void bindViews(const scene::Frame& frame);
  void finish(uint32_t slotIndex);
  bool isFinished(uint32_t slotIndex) const;
  void recordMoves(FrameSlot& slot);
};

Executor::Impl::~Impl() {
  vkDeviceWaitIdle(device.handle());
  slots.clear();
  passes.clear();
  freeResources(state);
}

void Executor::Impl::build(const Registry& registry, Impl* before) {
  residentAtStart = device.allocatedBytes();
  state.device = &device;
  state.plan = plan.get();
  state.hostProgress = options.hostProgress;
  state.countOperations = options.countOperations;
  state.sharedLayout = descriptors.setLayout();
  allocateResources(state);
  if (before && before->state.sharedLayout == state.sharedLayout)
    state.pipelines = pipelinesOf(before->passes);
  buildPasses(registry);
  state.pipelines.clear();
  const uint32_t frames = std::max(1u, options.framesInFlight);
  state.timestamps.emplace(device, uint32_t(4 + 2 * passes.size()) + kStepTimestamps, frames);
  for (uint32_t i = 0; i < frames; ++i) slots.emplace_back(state, passes, options.readback);
  if (before && options.keepContents) takeOver(*before);
}

// Comes last, when nothing can fail any more: it leaves the other executor without its kept resources.
void Executor::Impl::takeOver(Impl& before) {
  vkDeviceWaitIdle(device.handle());
  if (before.frameCount == 0) return;
  frameCount = before.frameCount;  // so that the copies of a history keep their turns
  state.parity = uint32_t(frameCount & 1);
  adoptResources(state, passes, before.state, before.passes);
}

void Executor::Impl::buildPasses(const Registry& registry) {
  addShaderFolders(device.shaders(), registry);
  uint64_t counterBytes = 0;
  const uint64_t alignment = std::max<uint64_t>(device.limits().minStorageBufferOffsetAlignment, 4);
  for (const Level& level : plan->levels) {
    for (uint32_t index : level.passes) {
      const BoundPass& bound = plan->graph->passes[index];
      const std::string& type = bound.declaration->type;
      const std::string_view plugin = registry.pluginOf(type);
      passes.push_back(std::make_unique<PassInstance>(
          state, index,
          guarded({bound.name, type, plugin}, "its constructor", [&] { return registry.create(type); })));
      PassInstance& pass = *passes.back();
      pass.plugin = plugin;
      const auto reserve = [&](uint64_t bytes) {
        return std::exchange(counterBytes, counterBytes + (bytes + alignment - 1) / alignment * alignment);
      };
      pass.counterOffset = reserve(pass.counterValues.size() * sizeof(uint32_t));
      pass.operationsOffset = reserve(state.countOperations ? gpu::kOperationsBytes : 0);
    }
  }
  state.counters =
      gpu::Buffer(device, {"counters", std::max<uint64_t>(counterBytes, 16),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           gpu::MemoryKind::Device});
  for (const auto& pass : passes) {
    if (pass->bound->declaration->kind == PassKind::Host) buildStaging(*pass);
    PrepareContext context(*pass);
    guarded(pass->origin(), "prepare()", [&] { pass->pass->prepare(context); });
    buildSteps(*pass, plan->steps[pass->index]);
  }
}

void Executor::Impl::buildStaging(PassInstance& pass) {
  pass.staging.resize(pass.bound->accesses.size());
  for (size_t i = 0; i < pass.staging.size(); ++i) {
    const Access& access = pass.bound->accesses[i];
    const std::string& name = plan->graph->resources[access.resource].name;
    const uint64_t bytes = std::max<uint64_t>(16, resourceBytes(pass.desc(access)));
    for (uint32_t s = 0; s < std::max(1u, options.framesInFlight); ++s)
      pass.staging[i].slots.emplace_back(
          device, gpu::BufferDesc{"host staging of " + name, bytes,
                                  VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  access.reads ? gpu::MemoryKind::Readback : gpu::MemoryKind::Upload});
  }
}

void Executor::Impl::bindViews(const scene::Frame& frame) {
  for (const auto& pass : passes) {
    const std::string& name = plan->graph->views[pass->bound->view];
    const auto view = std::find_if(frame.views.begin(), frame.views.end(),
                                   [&](const scene::View& v) { return v.name == name; });
    if (view == frame.views.end())
      throw Error(ExitCode::BadInput,
                  "pass `" + pass->bound->name + "` looks through view `" + name +
                      "`, which this frame does not have",
                  "give the frame a view of that name, or change `view` in the graph file");
    pass->viewIndex = static_cast<uint32_t>(view - frame.views.begin());
    pass->viewOffset = descriptors.viewOffset(pass->viewIndex);
  }
}

void Executor::Impl::beginSegment(FrameSlot& slot) {
  cmd = slot.command(segment);
  device.begin(cmd);
}

void Executor::Impl::submitSegment(FrameSlot& slot, bool last) {
  gpu::check(vkEndCommandBuffer(cmd), "ending a command buffer");
  VkCommandBufferSubmitInfo command{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  command.commandBuffer = cmd;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &command;
  gpu::check(vkQueueSubmit2(device.queue(), 1, &submit, slot.fence), "submitting a frame");
  if (last) return;
  gpu::check(vkWaitForFences(device.handle(), 1, &slot.fence, VK_TRUE, UINT64_MAX),
             "waiting for a host pass's inputs");
  gpu::check(vkResetFences(device.handle(), 1, &slot.fence), "resetting a fence");
  ++segment;
  beginSegment(slot);
}

void Executor::Impl::emitBarriers(const BarrierBatch& batch) {
  if (batch.empty()) return;
  VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  memory.srcStageMask = batch.srcStage;
  memory.srcAccessMask = batch.srcAccess;
  memory.dstStageMask = batch.dstStage;
  memory.dstAccessMask = batch.dstAccess;
  imageBarriers.clear();
  for (const ImageBarrier& b : batch.images) {
    const bool history = plan->graph->resources[b.resource].history;
    const uint32_t copy = !history ? 0 : b.previous ? 1 - state.parity : state.parity;
    const gpu::Image& image = state.resources[b.resource].images[copy];
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = b.srcStage;
    barrier.srcAccessMask = b.srcAccess;
    // The writes of the memory's last occupant may have been flushed many levels ago. Naming them again costs nothing
    // and helps the validation layer, which takes overlapping resources for one.
    if (b.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED) barrier.srcAccessMask |= VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = b.dstStage;
    barrier.dstAccessMask = b.dstAccess;
    barrier.oldLayout = b.oldLayout;
    barrier.newLayout = b.newLayout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = wholeImage(image);
    imageBarriers.push_back(barrier);
  }
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = batch.srcStage || batch.dstStage ? 1 : 0;
  info.pMemoryBarriers = &memory;
  info.imageMemoryBarrierCount = static_cast<uint32_t>(imageBarriers.size());
  info.pImageMemoryBarriers = imageBarriers.data();
  vkCmdPipelineBarrier2(cmd, &info);
}

std::optional<double> Executor::Impl::runHostPass(FrameSlot& slot, PassInstance& pass,
                                                  const scene::Frame& frame) {
  bool waits = false;
  std::optional<double> waited;
  for (size_t i = 0; i < pass.staging.size(); ++i) {
    const Access& a = pass.bound->accesses[i];
    if (!a.reads) continue;
    copyToStaging(cmd, state.resources[a.resource], state.copyIndex(a), a.layout,
                  pass.staging[i].slots[state.slot], resourceBytes(pass.desc(a)));
    waits = true;
  }
  if (waits) {
    gpu::memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    const auto start = Clock::now();
    submitSegment(slot, false);
    waited = millisecondsSince(start);
  }
  HostContext context(pass, frame, frameCount);
  guarded(pass.origin(), "execute()", [&] { pass.pass->execute(context); });
  for (size_t i = 0; i < pass.staging.size(); ++i) {
    const Access& a = pass.bound->accesses[i];
    if (!a.writes) continue;
    copyFromStaging(cmd, state.resources[a.resource], state.copyIndex(a), a.layout,
                    pass.staging[i].slots[state.slot], resourceBytes(pass.desc(a)));
  }
  return waited;
}

void Executor::Impl::recordMoves(FrameSlot& slot) {
  slot.moves = descriptors.moves();
  if (!slot.moves) return;
  device.beginLabel(cmd, "animate");
  writeTimestamp(state, cmd);
  descriptors.recordMoves(cmd, state.slot);
  slot.animateEnd = writeTimestamp(state, cmd);
  device.endLabel(cmd);
}

void Executor::Impl::runPass(FrameSlot& slot, PassInstance& pass, const scene::Frame& frame,
                             RecordedPass& recorded) {
  const auto start = Clock::now();
  std::optional<double> waited;
  std::fill(pass.counterSet.begin(), pass.counterSet.end(), false);
  device.beginLabel(cmd, pass.bound->name.c_str());
  recorded.begin = writeTimestamp(state, cmd);
  pass.begun.assign(1, {kNone, recorded.begin});
  pass.commands = {};
  pass.tracker.reset();
  if (pass.bound->declaration->kind == PassKind::Host) {
    device.endLabel(cmd);  // a label cannot span two command buffers
    waited = runHostPass(slot, pass, frame);
  } else {
    pass.host.begin(pass);
    if (pass.host) device.endLabel(cmd);
    RecordContext context(pass, cmd, frame, frameCount);
    guarded(pass.origin(), "record()", [&] { pass.pass->record(context); });
    pass.host.bringToDevice(pass, cmd);
    if (!pass.host) device.endLabel(cmd);
  }
  recorded.end = writeTimestamp(state, cmd);
  recorded.steps = pass.begun;
  recorded.commands = pass.commands;
  recorded.cpuMs = millisecondsSince(start) - waited.value_or(pass.host.waited());
  recorded.hostMs = waited ? recorded.cpuMs : pass.host.milliseconds();
  recorded.hostCounts.assign(pass.host.counters().begin(), pass.host.counters().end());
  recorded.counterValues = pass.counterValues;
  recorded.counterSet = pass.counterSet;
  if (slot.observe) slot.recordObserved(cmd, pass);
}

bool Executor::Impl::isFinished(uint32_t slotIndex) const {
  return vkGetFenceStatus(device.handle(), slots[slotIndex].fence) == VK_SUCCESS;
}

// Waits for the slot's frame and keeps its results.
void Executor::Impl::finish(uint32_t slotIndex) {
  FrameSlot& slot = slots[slotIndex];
  gpu::check(vkWaitForFences(device.handle(), 1, &slot.fence, VK_TRUE, UINT64_MAX), "waiting for a frame");
  const auto now = Clock::now();
  const auto times = state.timestamps->results(slot.number);
  if (!times) throw Error(ExitCode::Internal, "a finished frame has no timestamps");
  FrameResult result = slot.result(*times, passes);
  const auto since = lastFinish.value_or(slot.submitted);
  result.wallMs = std::chrono::duration<double, std::milli>(now - since).count();
  lastFinish = now;
  slot.busy = false;
  finished.push_back(std::move(result));
}

Executor::Executor(gpu::Device& device, std::shared_ptr<const Plan> plan, const Registry& registry,
                   scene::FrameDescriptors& scene, const ExecutorOptions& options, Executor* before)
    : impl_(std::make_unique<Impl>(device, std::move(plan), scene, options)) {
  impl_->build(registry, before ? before->impl_.get() : nullptr);
}

Executor::~Executor() = default;

void Executor::setInput(const std::string& name, std::span<const std::byte> bytes, float preExposure) {
  const BoundGraph& graph = *impl_->plan->graph;
  for (uint32_t i = 0; i < graph.resources.size(); ++i) {
    const BoundResource& resource = graph.resources[i];
    if (!resource.external || resource.name != name) continue;
    if (!impl_->plan->resourceLive[i]) return;
    if (const uint64_t wanted = givenBytes(resource.desc); bytes.size() != wanted)
      throw Error(ExitCode::BadInput,
                  "input `" + name + "` wants " + std::to_string(wanted) + " bytes, got " +
                      std::to_string(bytes.size()),
                  resource.desc.light > 0 ? "light is given as 32-bit floats" : "");
    std::vector<std::byte> stored;
    if (resource.desc.light > 0) {
      stored = inStoredUnits(resource.desc, bytes, preExposure);
      bytes = stored;
    }
    impl_->device.waitIdle();
    if (resource.desc.kind == ResourceKind::Image)
      gpu::upload(impl_->device, impl_->state.resources[i].images[0], bytes, impl_->plan->startLayout[i][0]);
    else
      gpu::upload(impl_->device, impl_->state.resources[i].buffers[0], bytes);
    return;
  }
  throw Error(ExitCode::BadInput, "graph " + graph.name + " has no input `" + name + "`");
}

void Executor::observe(std::vector<Observation> observations) {
  Impl& e = *impl_;
  while (!e.inFlight.empty()) {
    e.finish(e.inFlight.front());
    e.inFlight.pop_front();
  }
  for (FrameSlot& slot : e.slots) slot.setObserved(observations, e.passes);
}

void Executor::submit(const scene::Frame& frame, bool readOutputs, bool observe,
                      std::span<const OutputCopy> copies) {
  Impl& e = *impl_;
  const uint32_t slotIndex = static_cast<uint32_t>(e.frameCount % e.slots.size());
  FrameSlot& slot = e.slots[slotIndex];
  if (slot.busy) {
    e.finish(slotIndex);
    e.inFlight.pop_front();
  }
  const auto start = Clock::now();
  gpu::check(vkResetFences(e.device.handle(), 1, &slot.fence), "resetting a fence");
  gpu::check(vkResetCommandPool(e.device.handle(), slot.pool, 0), "resetting a command pool");
  slot.readOutputs = readOutputs;
  slot.observe = observe && !slot.observed.empty();
  slot.observeTimes.clear();
  slot.number = e.frameCount;
  slot.frame = frame.index;
  slot.preExposure = frame.preExposure;
  slot.submitted = start;
  e.state.slot = slotIndex;
  e.state.parity = static_cast<uint32_t>(e.frameCount & 1);
  e.state.cameraCut = frame.cameraCut;
  e.descriptors.update(frame, slotIndex);
  slot.animateCpuMs = e.descriptors.moves() ? millisecondsSince(start) : 0;
  e.state.sharedSet = e.descriptors.set(slotIndex);
  e.bindViews(frame);

  e.state.hostScene = e.plan->graph->raysOnHost ? e.descriptors.host(frame) : nullptr;
  e.state.finishAndBegin = [&] {
    e.submitSegment(slot, false);
    return e.cmd;
  };
  e.segment = 0;
  e.beginSegment(slot);
  e.state.timestamps->beginFrame(e.cmd, slot.number);
  e.state.stepTimestamps = kStepTimestamps;
  writeTimestamp(e.state, e.cmd);
  constexpr VkPipelineStageFlags2 kFirst =
      VK_PIPELINE_STAGE_2_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  constexpr VkAccessFlags2 kAny = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  gpu::memoryBarrier(e.cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kAny, kFirst, kAny);
  vkCmdFillBuffer(e.cmd, e.state.counters.handle(), 0, VK_WHOLE_SIZE, 0);
  e.recordMoves(slot);
  gpu::memoryBarrier(e.cmd, kFirst, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kAny);
  resetKeptResources(e.state, e.cmd);
  uint32_t position = 0;
  for (const Level& level : e.plan->levels) {
    e.emitBarriers(level.before);
    for (size_t i = 0; i < level.passes.size(); ++i, ++position) {
      e.runPass(slot, *e.passes[position], frame, slot.passes[position]);
      if (i == 0 && !level.before.empty()) ++slot.passes[position].commands.barriers;
    }
  }
  e.emitBarriers(e.plan->end);
  writeTimestamp(e.state, e.cmd);
  for (const OutputCopy& copy : copies) slot.recordCopy(e.cmd, copy);
  slot.recordReadback(e.cmd);
  e.submitSegment(slot, true);
  slot.cpuMs = millisecondsSince(start);
  slot.busy = true;
  e.inFlight.push_back(slotIndex);
  e.state.started = true;
  ++e.frameCount;
}

std::optional<FrameResult> Executor::poll() {
  Impl& e = *impl_;
  while (!e.inFlight.empty() && e.isFinished(e.inFlight.front())) {
    e.finish(e.inFlight.front());
    e.inFlight.pop_front();
  }
  if (e.finished.empty()) return std::nullopt;
  FrameResult result = std::move(e.finished.front());
  e.finished.pop_front();
  return result;
}

std::optional<FrameResult> Executor::next() {
  Impl& e = *impl_;
  if (e.finished.empty() && !e.inFlight.empty()) {
    e.finish(e.inFlight.front());
    e.inFlight.pop_front();
  }
  return poll();
}

ElementTypes Executor::elementTypes() const {
  ElementTypes types;
  for (const auto& pass : impl_->passes) {
    for (const KernelState& kernel : pass->kernels) {
      for (const gpu::ReflectedBinding& binding : kernel.pipeline->interface().bindings) {
        const uint32_t access = accessOfBinding(*pass->bound, binding.name);
        if (access == kNone || binding.element.empty()) continue;
        const ResourceDesc& desc = pass->desc(pass->bound->accesses[access]);
        // A shader may see the memory as something else, such as four numbers at a time.
        if (desc.kind == ResourceKind::Buffer && desc.stride == binding.elementBytes)
          types.emplace(desc.element, binding.element);
      }
    }
  }
  return types;
}

bool Executor::readsGeometry() const {
  return std::any_of(impl_->passes.begin(), impl_->passes.end(), [](const auto& pass) {
    return pass->bound->declaration->kind == PassKind::Host || pass->host;
  });
}

uint64_t Executor::residentBytes() const { return impl_->device.allocatedBytes() - impl_->residentAtStart; }

}  // namespace fovea::graph
