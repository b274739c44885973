#include "framework/graph/run/frame_slot.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/graph/run/light_units.h"

namespace fovea::graph {
namespace {

// The entry of this name; it is added if there is none.
StepTiming& stepTiming(std::vector<StepTiming>& steps, const std::string& name) {
  for (StepTiming& step : steps)
    if (step.name == name) return step;
  return steps.emplace_back(StepTiming{name, 0});
}

// What was copied of a resource.
OutputData readBack(const ResourceDesc& desc, const gpu::Buffer& copied, float preExposure) {
  const std::span texels(static_cast<const std::byte*>(copied.mapped()), resourceBytes(desc));
  return inSceneUnits(desc, texels, preExposure);
}

}  // namespace

uint32_t outputResource(const BoundGraph& graph, std::string_view name) {
  for (const BoundOutput& output : graph.outputs)
    if (output.name == name) return output.resource;
  std::vector<std::string> names;
  for (const BoundOutput& output : graph.outputs) names.push_back(output.name);
  const std::string nearest = nearestName(name, names);
  throw Error(ExitCode::BadInput, "graph " + graph.name + " has no output `" + std::string(name) + "`",
              nearest.empty() ? "" : "did you mean `" + nearest + "`?");
}

FrameSlot::FrameSlot(ExecutorState& executorState, const PassInstances& instances,
                     const std::vector<std::string>& readback)
    : FrameSlot(executorState) {
  gpu::Device& device = *state.device;
  const BoundGraph& graph = *state.plan->graph;
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = device.queueFamily();
  gpu::check(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool), "creating a command pool");
  VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  gpu::check(vkCreateFence(device.handle(), &fenceInfo, nullptr, &fence), "creating a fence");
  counters = gpu::Buffer(device, {"counters readback", state.counters.bytes(),
                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::Readback});
  for (const std::string& name : readback) {
    const uint32_t resource = outputResource(graph, name);
    const uint64_t bytes = std::max<uint64_t>(16, resourceBytes(graph.resources[resource].desc));
    outputs.push_back({name, resource,
                       gpu::Buffer(device, {"readback of output " + name, bytes,
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::Readback})});
  }
  passes.resize(instances.size());
}

VkCommandBuffer FrameSlot::command(uint32_t segment) {
  while (commands.size() <= segment) {
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    gpu::check(vkAllocateCommandBuffers(state.device->handle(), &allocate, &commands.emplace_back()),
               "allocating a command buffer");
  }
  return commands[segment];
}

FrameSlot::~FrameSlot() {
  for (const VkCommandBuffer cmd : commands) state.device->forget(cmd);
  const VkDevice device = state.device->handle();
  if (fence) vkDestroyFence(device, fence, nullptr);
  if (pool) vkDestroyCommandPool(device, pool, nullptr);
}

void FrameSlot::recordReadback(VkCommandBuffer cmd) {
  gpu::memoryBarrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                     VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  const VkBufferCopy all{0, 0, state.counters.bytes()};
  vkCmdCopyBuffer(cmd, state.counters.handle(), counters.handle(), 1, &all);
  if (readOutputs) {
    for (const Output& output : outputs) {
      const BoundResource& r = state.plan->graph->resources[output.resource];
      copyToStaging(cmd, state.resources[output.resource], r.history ? state.parity : 0,
                    state.plan->endLayout[output.resource], output.buffer, resourceBytes(r.desc));
    }
  }
  gpu::memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                     VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

FrameResult FrameSlot::result(std::span<const double> timestamps, const PassInstances& instances) const {
  const auto milliseconds = [&](size_t from, size_t to) {
    return std::max(0.0, (timestamps[to] - timestamps[from]) * 1e-6);
  };
  FrameResult result;
  result.frame = frame;
  result.cpuMs = cpuMs;
  result.gpuMs = timestamps.back() * 1e-6;
  result.animateMs = moves ? milliseconds(animateEnd - 1, animateEnd) : 0;
  result.animateCpuMs = animateCpuMs;
  for (size_t i = 0; i + 1 < observeTimes.size(); i += 2)
    result.observeMs += milliseconds(observeTimes[i], observeTimes[i + 1]);
  const auto* gpuCounters = static_cast<const std::byte*>(counters.mapped());
  for (size_t i = 0; i < instances.size(); ++i) {
    const PassInstance& pass = *instances[i];
    const RecordedPass& recorded = passes[i];
    const double gpuMs = milliseconds(recorded.begin, recorded.end) - recorded.hostMs;
    PassTiming& timing = result.passes.emplace_back(
        PassTiming{pass.index, std::max(gpuMs, 0.0), recorded.cpuMs, {}, recorded.commands});
    for (size_t s = 0; s < recorded.steps.size(); ++s) {
      const StepBegin& step = recorded.steps[s];
      if (step.label == kNone) continue;  // the pass recorded nothing
      const uint32_t end = s + 1 < recorded.steps.size() ? recorded.steps[s + 1].timestamp : recorded.end;
      stepTiming(timing.steps, pass.labels[step.label]).gpuMs += milliseconds(step.timestamp, end);
    }
    if (state.countOperations)
      std::memcpy(&timing.operations, gpuCounters + pass.operationsOffset, sizeof(timing.operations));
    const auto& declared = pass.bound->declaration->counters;
    for (size_t c = 0; c < declared.size(); ++c) {
      uint32_t counted;
      std::memcpy(&counted, gpuCounters + pass.counterOffset + c * sizeof(uint32_t), sizeof(counted));
      const uint64_t onHost = c < recorded.hostCounts.size() ? recorded.hostCounts[c] : 0;
      result.counters.emplace_back(
          pass.bound->name + "." + declared[c].name,
          recorded.counterSet[c] ? recorded.counterValues[c] : double(counted) + double(onHost));
    }
  }
  if (readOutputs) {
    for (const Output& output : outputs) {
      const ResourceDesc& desc = state.plan->graph->resources[output.resource].desc;
      result.outputs[output.name] = readBack(desc, output.buffer, preExposure);
    }
  }
  if (observe) {
    for (const Observed& o : observed) result.outputs[o.what.name] = readBack(o.desc, o.buffer, preExposure);
  }
  return result;
}

void copyToStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                   const gpu::Buffer& staging, uint64_t bytes) {
  if (r.images[copy]) {
    const auto regions = packedCopy(r.images[copy]);
    vkCmdCopyImageToBuffer(cmd, r.images[copy].handle(), layout, staging.handle(), uint32_t(regions.size()),
                           regions.data());
  } else {
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(cmd, r.buffers[copy].handle(), staging.handle(), 1, &region);
  }
}

void copyFromStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                     const gpu::Buffer& staging, uint64_t bytes) {
  if (r.images[copy]) {
    const auto regions = packedCopy(r.images[copy]);
    vkCmdCopyBufferToImage(cmd, staging.handle(), r.images[copy].handle(), layout, uint32_t(regions.size()),
                           regions.data());
  } else {
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(cmd, staging.handle(), r.buffers[copy].handle(), 1, &region);
  }
}

}  // namespace fovea::graph
