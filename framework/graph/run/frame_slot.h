// Internal to the executor: one frame in flight, from its command buffers to its results.
#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/graph/run/execute_state.h"

namespace fovea::graph {

using Clock = std::chrono::steady_clock;

inline double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

using PassInstances = std::vector<std::unique_ptr<PassInstance>>;  // in order of execution

// The CPU time that recording a pass took, and the counters that it set.
struct RecordedPass {
  double cpuMs = 0;              // excludes waiting for the device
  double hostMs = 0;             // the part of cpuMs during which the device waits in the middle of the pass
  uint32_t begin = 0, end = 0;   // indices of the timestamps around the pass
  std::vector<StepBegin> steps;  // in order; a step may begin more than once
  CommandCounts commands;
  std::vector<double> counterValues;
  std::vector<bool> counterSet;
  std::vector<uint64_t> hostCounts;  // by steps that ran on the host
};

struct FrameSlot {
  struct Output {
    std::string name;
    uint32_t resource;
    gpu::Buffer buffer;  // readback
  };

  struct Observed {
    Observation what;
    gpu::Buffer buffer;  // readback
    ResourceDesc desc;   // of what is read: one mip of one layer, or the beginning of a buffer
  };

  ExecutorState& state;
  VkCommandPool pool = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer>
      commands;  // one per segment: what needs results of the device on the host splits the frame
  VkFence fence = VK_NULL_HANDLE;
  gpu::Buffer counters;  // readback
  std::vector<Output> outputs;
  std::vector<Observed> observed;
  std::vector<uint32_t>
      observeTimes;  // indices of timestamps before and after each copy of an observed resource
  std::vector<RecordedPass> passes;
  bool busy = false, readOutputs = false, observe = false, moves = false;
  uint64_t number = 0;    // number of the frame since the executor was created
  uint64_t frame = 0;     // Frame::index
  float preExposure = 1;  // Frame::preExposure
  double cpuMs = 0, animateCpuMs = 0;
  uint32_t animateEnd = 0;  // index of the timestamp after the animation of vertices
  Clock::time_point submitted;

  // `readback` names graph outputs. Throws Error(BadInput) for names that the graph does not have.
  FrameSlot(ExecutorState& executorState, const PassInstances& instances,
            const std::vector<std::string>& readback);
  ~FrameSlot();
  FrameSlot(const FrameSlot&) = delete;
  FrameSlot& operator=(const FrameSlot&) = delete;

  // The command buffer of a segment, which is made when a frame has so many for the first time.
  VkCommandBuffer command(uint32_t segment);
  // Replaces what is observed; the slot must not be busy. Throws as Executor::observe does.
  void setObserved(const std::vector<Observation>& observations, const PassInstances& instances);
  // Copies what is observed of a pass; to be recorded right after it.
  void recordObserved(VkCommandBuffer cmd, const PassInstance& pass);
  // Copies an output into an image of somebody else's.
  void recordCopy(VkCommandBuffer cmd, const OutputCopy& copy);
  // Copies the counters and, if requested, the outputs into memory that the host can read.
  void recordReadback(VkCommandBuffer cmd);
  // The result without the wall time; call it after the fence has signalled. `timestamps` are in ns.
  FrameResult result(std::span<const double> timestamps, const PassInstances& instances) const;

 private:
  explicit FrameSlot(ExecutorState& executorState) : state(executorState) {}
};

// Index of the resource that is this output. Throws Error(BadInput) if the graph has none.
uint32_t outputResource(const BoundGraph& graph, std::string_view name);

// adopt.cpp: what an executor takes over from the one before it.
std::map<std::string, std::shared_ptr<gpu::Pipeline>, std::less<>> pipelinesOf(const PassInstances& passes);
// Moves kept and history resources of `before` that are the same in both plans, and tells passes of which all are.
void adoptResources(ExecutorState& state, PassInstances& passes, ExecutorState& before,
                    const PassInstances& passesBefore);

// Copies between a resource of the plan and a tightly packed buffer.
void copyToStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                   const gpu::Buffer& staging, uint64_t bytes);
void copyFromStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                     const gpu::Buffer& staging, uint64_t bytes);

}  // namespace fovea::graph
