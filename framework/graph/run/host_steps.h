// Steps of a pass that run on the host, among others that run on the device. What they read and write is copied between
// the two as it is needed. Internal to the executor.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "framework/gpu/resources.h"
#include "framework/graph/run/host_kernel.h"
#include "framework/graph/steps/steps.h"

namespace fovea::graph {

struct KernelState;
struct PassInstance;

class HostSteps {
 public:
  // Memory for what the kernels of the pass that run on the host reach through their bindings, and for the ports that
  // say how many groups of them there are.
  void prepare(PassInstance& pass);
  explicit operator bool() const { return !copies_.empty(); }

  // At the start of the pass in a frame: nothing is known of what the device has.
  void begin(const PassInstance& pass);
  // Runs a kernel, with groups from a buffer port (at `offset` bytes) if `indirect` names its access. `cmd` is ended,
  // submitted, waited for, and replaced, unless only kernels on the host came after the last wait.
  void run(PassInstance& pass, const KernelState& kernel, std::span<const std::byte> constants,
           std::array<uint32_t, 3> groups, std::optional<uint32_t> indirect, uint64_t offset,
           VkCommandBuffer& cmd);
  // Before commands of the device and at the end of the pass: brings over what the host has written. Returns whether
  // there was anything; then no earlier command has to be waited for.
  bool bringToDevice(PassInstance& pass, VkCommandBuffer cmd);
  // A command of the device reads and writes these.
  void note(std::span<const StepAccess> accesses);

  std::span<const uint64_t> counters() const { return counters_; }  // of this frame
  double milliseconds() const { return milliseconds_; }             // that the kernels of this frame took
  double waited() const { return waited_; }  // milliseconds in this frame, for the device

 private:
  struct Copy {  // of the resource behind an access
    gpu::Buffer memory;
    bool fresh = false;    // the same as on the device, or newer
    bool written = false;  // newer than on the device
  };
  void bringToHost(PassInstance& pass, const KernelState& kernel, std::optional<uint32_t> indirect,
                   VkCommandBuffer& cmd);

  std::vector<Copy> copies_;       // per access of the pass; empty if nothing runs on the host
  std::vector<uint8_t> contents_;  // per access: whether it holds anything that a kernel may read
  std::vector<uint64_t> counters_;
  double milliseconds_ = 0, waited_ = 0;
  bool idle_ = false;  // nothing was recorded since the device was waited for
};

}  // namespace fovea::graph
