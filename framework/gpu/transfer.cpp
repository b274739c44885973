// Set-up transfers through staging buffers. Each submission is fenced off from everything before and after it.
#include <algorithm>
#include <cstring>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/gpu/device.h"
#include "framework/gpu/format.h"
#include "framework/gpu/packed_mips.h"
#include "framework/gpu/resources.h"

namespace fovea::gpu {
namespace {

// Buffers are copied in pieces of this many bytes, so that staging does not double the memory.
constexpr uint64_t kStagingBytes = 32u << 20;

// beforeCopy() makes everything submitted before complete and visible to copies; afterCopy() makes copies visible to
// everything that follows, including the host.
void beforeCopy(VkCommandBuffer cmd) {
  memoryBarrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

void afterCopy(VkCommandBuffer cmd) {
  memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT);
}

void changeLayout(VkCommandBuffer cmd, const Image& image, VkImageLayout from, VkImageLayout to,
                  VkPipelineStageFlags2 srcStage, VkPipelineStageFlags2 dstStage) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = srcStage;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = dstStage;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle();
  barrier.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(cmd, &info);
}

uint64_t firstMipBytes(const Image& image) {
  const ImageDesc& d = image.desc();
  return uint64_t(d.width) * d.height * d.depth * d.layers * formatInfo(d.format).bytesPerTexel;
}

VkBufferImageCopy firstMip(const Image& image) {
  VkBufferImageCopy copy{};
  copy.imageSubresource = {image.aspect(), 0, 0, image.desc().layers};
  copy.imageExtent = image.extent();
  return copy;
}

}  // namespace

void upload(Device& device, Buffer& buffer, std::span<const std::byte> data, uint64_t offset) {
  if (offset > buffer.bytes() || data.size() > buffer.bytes() - offset) {
    throw Error(ExitCode::Internal, "upload of " + std::to_string(data.size()) + " bytes at " +
                                        std::to_string(offset) + " overruns buffer `" + buffer.name() +
                                        "` of " + std::to_string(buffer.bytes()) + " bytes");
  }
  if (data.empty()) return;
  if (buffer.mapped()) {
    std::memcpy(static_cast<std::byte*>(buffer.mapped()) + offset, data.data(), data.size());
    return;
  }
  const uint64_t piece = std::min<uint64_t>(data.size(), kStagingBytes);
  const Buffer staging(device, {"staging for " + buffer.name(), piece, 0, MemoryKind::Upload});
  for (uint64_t done = 0; done < data.size(); done += piece) {
    const uint64_t bytes = std::min<uint64_t>(piece, data.size() - done);
    std::memcpy(staging.mapped(), data.data() + done, bytes);
    device.runOnce([&](VkCommandBuffer cmd) {
      const VkBufferCopy copy{0, offset + done, bytes};
      beforeCopy(cmd);
      vkCmdCopyBuffer(cmd, staging.handle(), buffer.handle(), 1, &copy);
      afterCopy(cmd);
    });
  }
}

void upload(Device& device, Image& image, std::span<const std::byte> texels, VkImageLayout layout) {
  uint64_t bytes = texels.size();
  const std::vector<VkBufferImageCopy> copies = packedMips(image, bytes);
  if (copies.empty() || bytes != texels.size()) {
    throw Error(ExitCode::Internal, "upload of " + std::to_string(texels.size()) + " bytes to image `" +
                                        image.name() + "`, whose first mip level has " +
                                        std::to_string(firstMipBytes(image)));
  }
  const Buffer staging(device, {"staging for " + image.name(), texels.size(), 0, MemoryKind::Upload});
  std::memcpy(staging.mapped(), texels.data(), texels.size());
  device.runOnce([&](VkCommandBuffer cmd) {
    beforeCopy(cmd);
    changeLayout(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COPY_BIT);
    vkCmdCopyBufferToImage(cmd, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           uint32_t(copies.size()), copies.data());
    changeLayout(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout, VK_PIPELINE_STAGE_2_COPY_BIT,
                 VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  });
}

std::vector<std::byte> download(Device& device, const Buffer& buffer) {
  std::vector<std::byte> data(buffer.bytes());
  const uint64_t piece = std::min<uint64_t>(data.size(), kStagingBytes);
  const Buffer staging(device, {"staging for " + buffer.name(), piece, 0, MemoryKind::Readback});
  for (uint64_t done = 0; done < data.size(); done += piece) {
    const uint64_t bytes = std::min<uint64_t>(piece, data.size() - done);
    device.runOnce([&](VkCommandBuffer cmd) {
      const VkBufferCopy copy{done, 0, bytes};
      beforeCopy(cmd);
      vkCmdCopyBuffer(cmd, buffer.handle(), staging.handle(), 1, &copy);
      afterCopy(cmd);
    });
    std::memcpy(data.data() + done, staging.mapped(), bytes);
  }
  return data;
}

std::vector<std::byte> download(Device& device, const Image& image, VkImageLayout layout) {
  const uint64_t bytes = firstMipBytes(image);
  const Buffer staging(device, {"staging for " + image.name(), bytes, 0, MemoryKind::Readback});
  device.runOnce([&](VkCommandBuffer cmd) {
    const VkBufferImageCopy copy = firstMip(image);
    beforeCopy(cmd);
    changeLayout(cmd, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COPY_BIT);
    vkCmdCopyImageToBuffer(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle(), 1,
                           &copy);
    changeLayout(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout, VK_PIPELINE_STAGE_2_COPY_BIT,
                 VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    afterCopy(cmd);
  });
  const auto* first = static_cast<const std::byte*>(staging.mapped());
  return {first, first + bytes};
}

}  // namespace fovea::gpu
