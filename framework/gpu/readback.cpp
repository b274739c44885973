#include "framework/gpu/readback.h"

#include "framework/base/diagnostic.h"
#include "framework/gpu/device.h"
#include "framework/gpu/format.h"

namespace fovea::gpu {

ReadbackRing::ReadbackRing(Device& device, uint32_t framesInFlight)
    : device_(device), slots_(framesInFlight) {}

void ReadbackRing::beginFrame(uint64_t frame) {
  current_ = &slots_[frame % slots_.size()];
  current_->frame = frame;
  for (auto& [key, copy] : current_->copies) copy.used = false;
}

ReadbackRing::Copy& ReadbackRing::stage(const std::string& key, uint64_t bytes) {
  if (!current_) throw Error(ExitCode::Internal, "readback of `" + key + "` outside of a frame");
  Copy& copy = current_->copies[key];
  if (copy.used) throw Error(ExitCode::Internal, "`" + key + "` is read back twice in one frame");
  if (!copy.staging || copy.staging.bytes() < bytes) {
    copy.staging = {};  // first, so that old and new are never there together
    copy.staging = Buffer(device_, {"readback of " + key, bytes, 0, MemoryKind::Readback});
  }
  copy.bytes = bytes;
  copy.used = true;
  return copy;
}

void ReadbackRing::copy(VkCommandBuffer cmd, const std::string& key, const Buffer& source, uint64_t offset,
                        uint64_t bytes) {
  const Copy& target = stage(key, bytes);
  const VkBufferCopy region{offset, 0, bytes};
  vkCmdCopyBuffer(cmd, source.handle(), target.staging.handle(), 1, &region);
}

void ReadbackRing::copy(VkCommandBuffer cmd, const std::string& key, const Image& source,
                        VkImageLayout layout) {
  const ImageDesc& d = source.desc();
  const uint64_t texels = uint64_t(d.width) * d.height * d.depth * d.layers;
  const Copy& target = stage(key, texels * formatInfo(d.format).bytesPerTexel);
  VkBufferImageCopy region{};
  region.imageSubresource = {source.aspect(), 0, 0, d.layers};
  region.imageExtent = source.extent();
  vkCmdCopyImageToBuffer(cmd, source.handle(), layout, target.staging.handle(), 1, &region);
}

void ReadbackRing::endFrame(VkCommandBuffer cmd) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(cmd, &info);
}

std::span<const std::byte> ReadbackRing::data(uint64_t frame, const std::string& key) const {
  const Slot& slot = slots_[frame % slots_.size()];
  const auto it = slot.copies.find(key);
  if (slot.frame != frame || it == slot.copies.end() || !it->second.used) return {};
  return {static_cast<const std::byte*>(it->second.staging.mapped()), size_t(it->second.bytes)};
}

}  // namespace fovea::gpu
