// The frame loop: barriers of the plan, commands of the passes, timestamps, staging for host passes,
// readback.
#include "framework/graph/execute.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <optional>

#include "framework/base/diagnostic.h"
#include "framework/base/paths.h"
#include "framework/gpu/format.h"
#include "framework/graph/execute_state.h"
#include "framework/graph/registry.h"
#include "framework/scene/frame.h"
#include "framework/scene/gpu_scene.h"

namespace fovea::graph {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void memoryBarrier(VkCommandBuffer cmd, VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess,
                   VkPipelineStageFlags2 dstStage, VkAccessFlags2 dstAccess) {
  VkMemoryBarrier2 b{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  b.srcStageMask = srcStage;
  b.srcAccessMask = srcAccess;
  b.dstStageMask = dstStage;
  b.dstAccessMask = dstAccess;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &b;
  vkCmdPipelineBarrier2(cmd, &info);
}

void copyToStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                   const gpu::Buffer& staging, uint64_t bytes) {
  if (r.images[copy]) {
    const auto regions = packedCopy(r.images[copy]);
    vkCmdCopyImageToBuffer(cmd, r.images[copy].handle(), layout, staging.handle(),
                           static_cast<uint32_t>(regions.size()), regions.data());
  } else {
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(cmd, r.buffers[copy].handle(), staging.handle(), 1, &region);
  }
}

void copyFromStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                     const gpu::Buffer& staging, uint64_t bytes) {
  if (r.images[copy]) {
    const auto regions = packedCopy(r.images[copy]);
    vkCmdCopyBufferToImage(cmd, staging.handle(), r.images[copy].handle(), layout,
                           static_cast<uint32_t>(regions.size()), regions.data());
  } else {
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(cmd, staging.handle(), r.buffers[copy].handle(), 1, &region);
  }
}

// One frame in flight.
struct Slot {
  VkCommandPool pool = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> commands;  // one a segment: host passes with GPU inputs split the frame
  VkFence fence = VK_NULL_HANDLE;
  VkQueryPool queries = VK_NULL_HANDLE;
  gpu::Buffer counters;                                      // readback
  std::vector<std::pair<std::string, gpu::Buffer>> outputs;  // readback
  bool busy = false, readOutputs = false;
  uint64_t frame = 0;
  double cpuMs = 0, animateCpuMs = 0;
  Clock::time_point submitted;
  std::vector<double> passCpuMs;                   // in execution order, without waiting for the device
  std::vector<double> passHostMs;                  // of that, while the device waits in the midst of the pass
  std::vector<std::vector<double>> counterValues;  // per pass, as set by the CPU
  std::vector<std::vector<bool>> counterSet;
};

}  // namespace

struct Executor::Impl {
  gpu::Device& device;
  std::shared_ptr<const Plan> plan;
  scene::GpuScene& gpuScene;
  ExecutorOptions options;
  ExecutorState state;
  std::vector<uint32_t> order;                        // live passes in execution order
  std::vector<std::unique_ptr<PassInstance>> passes;  // by index in the graph; null when culled
  std::vector<Slot> slots;
  std::deque<uint32_t> inFlight;  // slots, oldest first
  std::deque<FrameResult> finished;
  uint64_t frameCount = 0;
  uint64_t residentAtStart = 0;
  std::optional<Clock::time_point> lastFinish;
  VkCommandBuffer cmd = VK_NULL_HANDLE;
  uint32_t segment = 0;

  Impl(gpu::Device& d, std::shared_ptr<const Plan> p, scene::GpuScene& s, const ExecutorOptions& o)
      : device(d), plan(std::move(p)), gpuScene(s), options(o) {}
  ~Impl();

  void build(const Registry& registry);
  void buildPasses(const Registry& registry);
  void buildSlot(Slot& slot);
  void buildStaging(PassInstance& pass);
  uint32_t outputResource(const std::string& name) const;

  void beginSegment(Slot& slot);
  void submitSegment(Slot& slot, bool last);
  void emitBarriers(const BarrierBatch& batch);
  void runPass(Slot& slot, PassInstance& pass, const scene::Frame& frame, uint32_t position);
  // Milliseconds spent on waiting for the device; nothing when the pass reads nothing of it.
  std::optional<double> runHostPass(Slot& slot, PassInstance& pass, const scene::Frame& frame);
  void recordReadback(Slot& slot);
  void bindViews(const scene::Frame& frame);
  void finish(uint32_t slotIndex);
  bool isFinished(uint32_t slotIndex) const;
  // First of the frame, two a pass, two around the vertices of what moves, last of the frame.
  uint32_t queryCount() const { return static_cast<uint32_t>(4 + 2 * order.size()); }
  uint32_t animateQuery() const { return queryCount() - 3; }
  void recordMoves(Slot& slot);
  void flushTimestamp();
};

Executor::Impl::~Impl() {
  vkDeviceWaitIdle(device.handle());
  for (Slot& slot : slots) {
    if (slot.queries) vkDestroyQueryPool(device.handle(), slot.queries, nullptr);
    if (slot.fence) vkDestroyFence(device.handle(), slot.fence, nullptr);
    if (slot.pool) vkDestroyCommandPool(device.handle(), slot.pool, nullptr);
  }
  slots.clear();
  passes.clear();
  freeResources(state);
}

void Executor::Impl::build(const Registry& registry) {
  residentAtStart = device.allocatedBytes();
  state.device = &device;
  state.plan = plan.get();
  state.hostProgress = options.hostProgress;
  state.sharedLayout = gpuScene.setLayout();
  allocateResources(state);
  for (const Level& level : plan->levels) order.insert(order.end(), level.passes.begin(), level.passes.end());
  buildPasses(registry);
  slots.resize(std::max(1u, options.framesInFlight));
  for (Slot& slot : slots) buildSlot(slot);
}

void Executor::Impl::buildPasses(const Registry& registry) {
  for (const auto& path : dataFolders("shaders")) device.shaders().addSearchPath(path);
  for (const auto& path : registry.pluginShaderPaths()) device.shaders().addSearchPath(path);
  passes.resize(plan->graph->passes.size());
  uint64_t counterBytes = 0;
  const uint64_t alignment = std::max<uint64_t>(device.limits().minStorageBufferOffsetAlignment, 4);
  for (uint32_t index : order) {
    auto& pass = passes[index];
    pass = std::make_unique<PassInstance>(state, index,
                                          registry.create(plan->graph->passes[index].declaration->type));
    pass->counterOffset = counterBytes;
    counterBytes += (pass->counterValues.size() * sizeof(uint32_t) + alignment - 1) / alignment * alignment;
  }
  state.counters =
      gpu::Buffer(device, {"counters", std::max<uint64_t>(counterBytes, 16),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           gpu::MemoryKind::Device});
  for (uint32_t index : order) {
    if (passes[index]->bound->declaration->kind == PassKind::Host) buildStaging(*passes[index]);
    PrepareContext context(*passes[index]);
    passes[index]->pass->prepare(context);
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

uint32_t Executor::Impl::outputResource(const std::string& name) const {
  std::vector<std::string> names;
  for (const BoundOutput& output : plan->graph->outputs) {
    if (output.name == name) return output.resource;
    names.push_back(output.name);
  }
  const std::string nearest = nearestName(name, names);
  throw Error(ExitCode::BadInput, "graph " + plan->graph->name + " has no output `" + name + "`",
              nearest.empty() ? "" : "did you mean `" + nearest + "`?");
}

void Executor::Impl::buildSlot(Slot& slot) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = device.queueFamily();
  gpu::check(vkCreateCommandPool(device.handle(), &pool, nullptr, &slot.pool), "creating a command pool");
  // A segment for the start and one for each host pass that has to wait for the GPU.
  uint32_t segments = 1;
  for (uint32_t index : order) {
    const BoundPass& pass = *passes[index]->bound;
    if (pass.declaration->kind != PassKind::Host) continue;
    segments +=
        std::any_of(pass.accesses.begin(), pass.accesses.end(), [](const Access& a) { return a.reads; });
  }
  slot.commands.resize(segments);
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = slot.pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = segments;
  gpu::check(vkAllocateCommandBuffers(device.handle(), &allocate, slot.commands.data()),
             "allocating command buffers");
  VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  gpu::check(vkCreateFence(device.handle(), &fence, nullptr, &slot.fence), "creating a fence");
  VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
  queries.queryCount = queryCount();
  gpu::check(vkCreateQueryPool(device.handle(), &queries, nullptr, &slot.queries),
             "creating timestamp queries");
  slot.counters = gpu::Buffer(device, {"counters readback", state.counters.bytes(),
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::Readback});
  for (const std::string& name : options.readback) {
    const BoundResource& resource = plan->graph->resources[outputResource(name)];
    slot.outputs.emplace_back(
        name, gpu::Buffer(device,
                          {"readback of output " + name, std::max<uint64_t>(16, resourceBytes(resource.desc)),
                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::Readback}));
  }
  slot.counterValues.resize(order.size());
  slot.counterSet.resize(order.size());
  slot.passCpuMs.resize(order.size());
  slot.passHostMs.resize(order.size());
}

void Executor::Impl::bindViews(const scene::Frame& frame) {
  for (uint32_t index : order) {
    PassInstance& pass = *passes[index];
    const std::string& name = plan->graph->views[pass.bound->view];
    const auto view = std::find_if(frame.views.begin(), frame.views.end(),
                                   [&](const scene::View& v) { return v.name == name; });
    if (view == frame.views.end())
      throw Error(
          ExitCode::BadInput,
          "pass `" + pass.bound->name + "` looks through view `" + name + "`, which this frame does not have",
          "give the frame a view of that name, or change `view` in the graph file");
    pass.viewIndex = static_cast<uint32_t>(view - frame.views.begin());
    pass.viewOffset = gpuScene.viewOffset(pass.viewIndex);
  }
}

void Executor::Impl::beginSegment(Slot& slot) {
  cmd = slot.commands[segment];
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  gpu::check(vkBeginCommandBuffer(cmd, &begin), "beginning a command buffer");
}

void Executor::Impl::submitSegment(Slot& slot, bool last) {
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
  std::vector<VkImageMemoryBarrier2> images;
  images.reserve(batch.images.size());
  for (const ImageBarrier& b : batch.images) {
    const bool history = plan->graph->resources[b.resource].history;
    const uint32_t copy = !history ? 0 : b.previous ? 1 - state.parity : state.parity;
    const gpu::Image& image = state.resources[b.resource].images[copy];
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = b.srcStage;
    barrier.srcAccessMask = b.srcAccess;
    // What the memory's last occupant wrote may have been flushed levels ago. Naming it again costs nothing
    // and lets validation follow, which takes an overlap for one resource.
    if (b.oldLayout == VK_IMAGE_LAYOUT_UNDEFINED) barrier.srcAccessMask |= VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = b.dstStage;
    barrier.dstAccessMask = b.dstAccess;
    barrier.oldLayout = b.oldLayout;
    barrier.newLayout = b.newLayout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = wholeImage(image);
    images.push_back(barrier);
  }
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = batch.srcStage || batch.dstStage ? 1 : 0;
  info.pMemoryBarriers = &memory;
  info.imageMemoryBarrierCount = static_cast<uint32_t>(images.size());
  info.pImageMemoryBarriers = images.data();
  vkCmdPipelineBarrier2(cmd, &info);
}

std::optional<double> Executor::Impl::runHostPass(Slot& slot, PassInstance& pass, const scene::Frame& frame) {
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
    memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    const auto start = Clock::now();
    submitSegment(slot, false);
    waited = millisecondsSince(start);
  }
  HostContext context(pass, frame, frameCount);
  pass.pass->execute(context);
  for (size_t i = 0; i < pass.staging.size(); ++i) {
    const Access& a = pass.bound->accesses[i];
    if (!a.writes) continue;
    copyFromStaging(cmd, state.resources[a.resource], state.copyIndex(a), a.layout,
                    pass.staging[i].slots[state.slot], resourceBytes(pass.desc(a)));
  }
  return waited;
}

// Lavapipe takes a timestamp at the next flush, but dispatches at once: without a flush in between (an empty
// barrier is one) a pass of dispatches alone would start after its own work.
void Executor::Impl::flushTimestamp() {
  if (!device.isCpu()) return;
  const VkDependencyInfo nothing{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  vkCmdPipelineBarrier2(cmd, &nothing);
}

void Executor::Impl::recordMoves(Slot& slot) {
  if (!gpuScene.moves()) return;
  device.beginLabel(cmd, "animate");
  vkCmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.queries, animateQuery());
  flushTimestamp();
  gpuScene.recordMoves(cmd, state.slot);
  flushTimestamp();
  vkCmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.queries, animateQuery() + 1);
  device.endLabel(cmd);
}

void Executor::Impl::runPass(Slot& slot, PassInstance& pass, const scene::Frame& frame, uint32_t position) {
  const auto start = Clock::now();
  std::optional<double> waited;
  std::fill(pass.counterSet.begin(), pass.counterSet.end(), false);
  device.beginLabel(cmd, pass.bound->name.c_str());
  vkCmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.queries, 1 + 2 * position);
  flushTimestamp();
  if (pass.bound->declaration->kind == PassKind::Host) {
    device.endLabel(cmd);  // a label cannot span two command buffers
    waited = runHostPass(slot, pass, frame);
  } else {
    RecordContext context(pass, cmd, frame, frameCount);
    pass.pass->record(context);
    device.endLabel(cmd);
  }
  vkCmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.queries, 2 + 2 * position);
  slot.passCpuMs[position] = millisecondsSince(start) - waited.value_or(0);
  slot.passHostMs[position] = waited ? slot.passCpuMs[position] : 0;
  slot.counterValues[position] = pass.counterValues;
  slot.counterSet[position] = pass.counterSet;
}

void Executor::Impl::recordReadback(Slot& slot) {
  memoryBarrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  const VkBufferCopy all{0, 0, state.counters.bytes()};
  vkCmdCopyBuffer(cmd, state.counters.handle(), slot.counters.handle(), 1, &all);
  if (slot.readOutputs) {
    for (auto& [name, buffer] : slot.outputs) {
      const uint32_t resource = outputResource(name);
      const BoundResource& r = plan->graph->resources[resource];
      copyToStaging(cmd, state.resources[resource], r.history ? state.parity : 0, plan->endLayout[resource],
                    buffer, resourceBytes(r.desc));
    }
  }
  memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

bool Executor::Impl::isFinished(uint32_t slotIndex) const {
  return vkGetFenceStatus(device.handle(), slots[slotIndex].fence) == VK_SUCCESS;
}

// Waits for the slot's frame and turns its queries, counters and outputs into a FrameResult.
void Executor::Impl::finish(uint32_t slotIndex) {
  Slot& slot = slots[slotIndex];
  gpu::check(vkWaitForFences(device.handle(), 1, &slot.fence, VK_TRUE, UINT64_MAX), "waiting for a frame");
  const auto now = Clock::now();
  std::vector<uint64_t> ticks(queryCount());
  const auto read = [&](uint32_t first, uint32_t count) {
    gpu::check(vkGetQueryPoolResults(device.handle(), slot.queries, first, count, count * sizeof(uint64_t),
                                     &ticks[first], sizeof(uint64_t),
                                     VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
               "reading timestamps");
  };
  read(0, animateQuery());
  if (gpuScene.moves()) read(animateQuery(), 2);
  read(queryCount() - 1, 1);
  const double toMs = device.timestampPeriodNs() * 1e-6;
  FrameResult result;
  result.frame = slot.frame;
  result.cpuMs = slot.cpuMs;
  result.gpuMs = double(ticks.back() - ticks.front()) * toMs;
  result.animateMs = double(ticks[animateQuery() + 1] - ticks[animateQuery()]) * toMs;
  result.animateCpuMs = slot.animateCpuMs;
  const auto since = lastFinish.value_or(slot.submitted);
  result.wallMs = std::chrono::duration<double, std::milli>(now - since).count();
  lastFinish = now;
  const auto* gpuCounters = static_cast<const std::byte*>(slot.counters.mapped());
  for (size_t i = 0; i < order.size(); ++i) {
    const PassInstance& pass = *passes[order[i]];
    result.passes.push_back(
        {order[i], std::max(double(ticks[2 + 2 * i] - ticks[1 + 2 * i]) * toMs - slot.passHostMs[i], 0.0),
         slot.passCpuMs[i]});
    const auto& counters = pass.bound->declaration->counters;
    for (size_t c = 0; c < counters.size(); ++c) {
      uint32_t counted;
      std::memcpy(&counted, gpuCounters + pass.counterOffset + c * sizeof(uint32_t), sizeof(counted));
      result.counters.emplace_back(pass.bound->name + "." + counters[c].name,
                                   slot.counterSet[i][c] ? slot.counterValues[i][c] : double(counted));
    }
  }
  if (slot.readOutputs) {
    for (auto& [name, buffer] : slot.outputs) {
      OutputData& data = result.outputs[name];
      data.desc = plan->graph->resources[outputResource(name)].desc;
      data.bytes.resize(resourceBytes(data.desc));
      std::memcpy(data.bytes.data(), buffer.mapped(), data.bytes.size());
    }
  }
  slot.busy = false;
  finished.push_back(std::move(result));
}

Executor::Executor(gpu::Device& device, std::shared_ptr<const Plan> plan, const Registry& registry,
                   scene::GpuScene& scene, const ExecutorOptions& options)
    : impl_(std::make_unique<Impl>(device, std::move(plan), scene, options)) {
  impl_->build(registry);
}

Executor::~Executor() = default;

void Executor::setInput(const std::string& name, std::span<const std::byte> bytes) {
  const BoundGraph& graph = *impl_->plan->graph;
  for (uint32_t i = 0; i < graph.resources.size(); ++i) {
    const BoundResource& resource = graph.resources[i];
    if (!resource.external || resource.name != name) continue;
    if (!impl_->plan->resourceLive[i]) return;
    if (bytes.size() != resourceBytes(resource.desc))
      throw Error(ExitCode::BadInput, "input `" + name + "` wants " +
                                          std::to_string(resourceBytes(resource.desc)) + " bytes, got " +
                                          std::to_string(bytes.size()));
    impl_->device.waitIdle();
    if (resource.desc.kind == ResourceKind::Image)
      gpu::upload(impl_->device, impl_->state.resources[i].images[0], bytes, impl_->plan->startLayout[i][0]);
    else
      gpu::upload(impl_->device, impl_->state.resources[i].buffers[0], bytes);
    return;
  }
  throw Error(ExitCode::BadInput, "graph " + graph.name + " has no input `" + name + "`");
}

void Executor::submit(const scene::Frame& frame, bool readOutputs) {
  Impl& e = *impl_;
  const uint32_t slotIndex = static_cast<uint32_t>(e.frameCount % e.slots.size());
  Slot& slot = e.slots[slotIndex];
  if (slot.busy) {
    e.finish(slotIndex);
    e.inFlight.pop_front();
  }
  const auto start = Clock::now();
  gpu::check(vkResetFences(e.device.handle(), 1, &slot.fence), "resetting a fence");
  gpu::check(vkResetCommandPool(e.device.handle(), slot.pool, 0), "resetting a command pool");
  slot.readOutputs = readOutputs;
  slot.frame = frame.index;
  slot.submitted = start;
  e.state.slot = slotIndex;
  e.state.parity = static_cast<uint32_t>(e.frameCount & 1);
  e.state.sceneReset = e.frameCount == 0;
  e.state.viewReset = e.state.sceneReset || frame.cameraCut;
  e.gpuScene.update(frame, slotIndex);
  slot.animateCpuMs = e.gpuScene.moves() ? millisecondsSince(start) : 0;
  e.state.sharedSet = e.gpuScene.set(slotIndex);
  e.bindViews(frame);

  e.segment = 0;
  e.beginSegment(slot);
  vkCmdResetQueryPool(e.cmd, slot.queries, 0, e.queryCount());
  vkCmdWriteTimestamp2(e.cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.queries, 0);
  constexpr VkPipelineStageFlags2 kFirst =
      VK_PIPELINE_STAGE_2_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  constexpr VkAccessFlags2 kAny = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  memoryBarrier(e.cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kAny, kFirst, kAny);
  vkCmdFillBuffer(e.cmd, e.state.counters.handle(), 0, VK_WHOLE_SIZE, 0);
  e.recordMoves(slot);
  memoryBarrier(e.cmd, kFirst, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, kAny);
  if (e.state.viewReset) zeroKeptResources(e.state, e.cmd, e.state.sceneReset);
  uint32_t position = 0;
  for (const Level& level : e.plan->levels) {
    e.emitBarriers(level.before);
    for (uint32_t index : level.passes) e.runPass(slot, *e.passes[index], frame, position++);
  }
  e.emitBarriers(e.plan->end);
  vkCmdWriteTimestamp2(e.cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.queries, e.queryCount() - 1);
  e.recordReadback(slot);
  e.submitSegment(slot, true);
  slot.cpuMs = millisecondsSince(start);
  slot.busy = true;
  e.inFlight.push_back(slotIndex);
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

bool Executor::readsGeometry() const {
  return std::any_of(impl_->order.begin(), impl_->order.end(), [&](uint32_t index) {
    return impl_->passes[index]->bound->declaration->kind == PassKind::Host;
  });
}

uint64_t Executor::residentBytes() const { return impl_->device.allocatedBytes() - impl_->residentAtStart; }

}  // namespace fovea::graph
