#include "framework/gpu/timestamps.h"

#include <string>

#include "fovea/error.h"
#include "framework/gpu/device.h"

namespace fovea::gpu {

TimestampRing::TimestampRing(Device& device, uint32_t maxPerFrame, uint32_t framesInFlight)
    : device_(device), maxPerFrame_(maxPerFrame), slots_(framesInFlight) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device.physical(), &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device.physical(), &count, families.data());
  const uint32_t bits = families[device.queueFamily()].timestampValidBits;
  if (bits < 64) tickMask_ = (uint64_t(1) << bits) - 1;
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = maxPerFrame;
  for (Slot& slot : slots_) {
    check(vkCreateQueryPool(device.handle(), &info, nullptr, &slot.pool), "creating a timestamp pool");
    device.setName(VK_OBJECT_TYPE_QUERY_POOL, reinterpret_cast<uint64_t>(slot.pool), "timestamps");
  }
}

TimestampRing::~TimestampRing() {
  for (const Slot& slot : slots_) vkDestroyQueryPool(device_.handle(), slot.pool, nullptr);
}

void TimestampRing::beginFrame(VkCommandBuffer cmd, uint64_t frame) {
  current_ = &slots_[frame % slots_.size()];
  current_->frame = frame;
  current_->written = 0;
  vkCmdResetQueryPool(cmd, current_->pool, 0, maxPerFrame_);
}

uint32_t TimestampRing::write(VkCommandBuffer cmd, VkPipelineStageFlags2 stage) {
  if (!current_ || current_->written == maxPerFrame_) {
    throw Error(ExitCode::Internal, "a frame has room for " + std::to_string(maxPerFrame_) +
                                        " timestamps, and only between beginFrame and the next one");
  }
  vkCmdWriteTimestamp2(cmd, stage, current_->pool, current_->written);
  return current_->written++;
}

std::optional<std::vector<double>> TimestampRing::results(uint64_t frame) const {
  const Slot& slot = slots_[frame % slots_.size()];
  if (slot.frame != frame) return std::nullopt;
  std::vector<double> times(slot.written);
  if (times.empty()) return times;
  std::vector<uint64_t> ticks(slot.written);
  const VkResult result =
      vkGetQueryPoolResults(device_.handle(), slot.pool, 0, slot.written, ticks.size() * sizeof(uint64_t),
                            ticks.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
  if (result == VK_NOT_READY) return std::nullopt;
  check(result, "reading timestamps");
  for (size_t i = 0; i < times.size(); ++i)
    times[i] = double((ticks[i] - ticks[0]) & tickMask_) * double(device_.timestampPeriodNs());
  return times;
}

}  // namespace fovea::gpu
