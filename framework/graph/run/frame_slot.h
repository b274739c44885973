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
  std::vector<double> counterValues;
  std::vector<bool> counterSet;
};

struct FrameSlot {
  struct Output {
    std::string name;
    uint32_t resource;
    gpu::Buffer buffer;  // readback
  };

  ExecutorState& state;
  VkCommandPool pool = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> commands;  // one per segment; host passes with GPU inputs split the frame
  VkFence fence = VK_NULL_HANDLE;
  gpu::Buffer counters;  // readback
  std::vector<Output> outputs;
  std::vector<RecordedPass> passes;
  bool busy = false, readOutputs = false, moves = false;
  uint64_t number = 0;  // number of the frame since the executor was created
  uint64_t frame = 0;   // Frame::index
  double cpuMs = 0, animateCpuMs = 0;
  uint32_t animateEnd = 0;  // index of the timestamp after the animation of vertices
  Clock::time_point submitted;

  // `readback` names graph outputs. Throws Error(BadInput) for names that the graph does not have.
  FrameSlot(ExecutorState& executorState, const PassInstances& instances,
            const std::vector<std::string>& readback);
  ~FrameSlot();
  FrameSlot(const FrameSlot&) = delete;
  FrameSlot& operator=(const FrameSlot&) = delete;

  // Copies the counters and, if requested, the outputs into memory that the host can read.
  void recordReadback(VkCommandBuffer cmd);
  // The result without the wall time; call it after the fence has signalled. `timestamps` are in ns.
  FrameResult result(std::span<const double> timestamps, const PassInstances& instances) const;

 private:
  explicit FrameSlot(ExecutorState& executorState) : state(executorState) {}
};

// Copies between a resource of the plan and a tightly packed buffer.
void copyToStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                   const gpu::Buffer& staging, uint64_t bytes);
void copyFromStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                     const gpu::Buffer& staging, uint64_t bytes);

}  // namespace fovea::graph
