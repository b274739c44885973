// Internal to the executor: one frame in flight, from its command buffers to what it brings back.
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

// What recording a pass took on the CPU, and what it counted there.
struct RecordedPass {
  double cpuMs = 0;   // without waiting for the device
  double hostMs = 0;  // of that, while the device waits in the midst of the pass
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
  std::vector<VkCommandBuffer> commands;  // one a segment: host passes with GPU inputs split the frame
  VkFence fence = VK_NULL_HANDLE;
  gpu::Buffer counters;  // readback
  std::vector<Output> outputs;
  std::vector<RecordedPass> passes;
  bool busy = false, readOutputs = false, moves = false;
  uint64_t number = 0;  // of the frame, since the executor was made
  uint64_t frame = 0;   // Frame::index
  double cpuMs = 0, animateCpuMs = 0;
  Clock::time_point submitted;

  // `readback`: graph outputs. Throws Error(BadInput) for those that the graph lacks.
  FrameSlot(ExecutorState& executorState, const PassInstances& instances,
            const std::vector<std::string>& readback);
  ~FrameSlot();
  FrameSlot(const FrameSlot&) = delete;
  FrameSlot& operator=(const FrameSlot&) = delete;

  // Copies counters, and outputs when they are asked for, to where the host can read them.
  void recordReadback(VkCommandBuffer cmd);
  // All but the wall time, once the fence has signalled. `timestamps`, ns: first of the frame, two around the
  // vertices of what moves when anything does, two a pass, last of the frame.
  FrameResult result(std::span<const double> timestamps, const PassInstances& instances) const;

 private:
  explicit FrameSlot(ExecutorState& executorState) : state(executorState) {}
};

// Between a resource of the plan and a tightly packed buffer.
void copyToStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                   const gpu::Buffer& staging, uint64_t bytes);
void copyFromStaging(VkCommandBuffer cmd, const PhysicalResource& r, uint32_t copy, VkImageLayout layout,
                     const gpu::Buffer& staging, uint64_t bytes);

}  // namespace fovea::graph
