// GPU times of frames in flight, which are written now, read some frames later and never waited for.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace fovea::gpu {

class Device;

// A frame uses the slot frame % framesInFlight.
class TimestampRing {
 public:
  TimestampRing(Device& device, uint32_t maxPerFrame, uint32_t framesInFlight);
  ~TimestampRing();
  TimestampRing(const TimestampRing&) = delete;
  TimestampRing& operator=(const TimestampRing&) = delete;

  // To be called outside of rendering. The fence of frame - framesInFlight must have
  // signalled; its results are dropped.
  void beginFrame(VkCommandBuffer cmd, uint64_t frame);
  // Writes the time at which everything recorded before has passed `stage`. Returns the index into results(). Throws
  // Error(Internal) beyond maxPerFrame.
  uint32_t write(VkCommandBuffer cmd, VkPipelineStageFlags2 stage);
  // Nanoseconds since the frame's first timestamp; nullopt while the GPU is not done, or if a later
  // frame has taken the slot.
  std::optional<std::vector<double>> results(uint64_t frame) const;

 private:
  struct Slot {
    VkQueryPool pool = VK_NULL_HANDLE;
    std::optional<uint64_t> frame;
    uint32_t written = 0;
  };
  Device& device_;
  uint32_t maxPerFrame_;
  uint64_t tickMask_ = ~uint64_t(0);  // counters may have fewer than 64 bits, and wrap
  std::vector<Slot> slots_;
  Slot* current_ = nullptr;
};

}  // namespace fovea::gpu
