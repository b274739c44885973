// Reads resources back in the middle of a frame, for viewers of a running graph.
#include <algorithm>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/graph/run/frame_slot.h"

namespace fovea::graph {
namespace {

uint32_t part(uint32_t side, uint32_t mip) { return std::max(1u, side >> mip); }

// One mip of one layer, or as many elements as fit.
ResourceDesc observedPart(const ResourceDesc& all, const Observation& what) {
  ResourceDesc desc = all;
  if (all.kind == ResourceKind::Buffer) {
    desc.count = std::min<uint64_t>(all.count, what.mostBytes / std::max(1u, all.stride));
    return desc;
  }
  desc.width = part(all.width, what.mip);
  desc.height = part(all.height, what.mip);
  desc.depth = desc.layers = desc.mips = 1;
  desc.volume = desc.array = false;
  return desc;
}

constexpr VkImageLayout kWritten = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;  // of the target of a copy

void barrier(VkCommandBuffer cmd, const VkImageMemoryBarrier2& image) {
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &image;
  vkCmdPipelineBarrier2(cmd, &info);
}

// The image is in `layout` before and after.
void copyImage(VkCommandBuffer cmd, const gpu::Image& image, VkImageLayout layout, const Observation& what,
               const ResourceDesc& desc, const gpu::Buffer& to) {
  const bool volume = image.desc().type == VK_IMAGE_TYPE_3D;
  VkBufferImageCopy region{};
  region.imageSubresource = {image.aspect(), what.mip, volume ? 0 : what.layer, 1};
  region.imageOffset.z = volume ? int32_t(what.layer) : 0;
  region.imageExtent = {desc.width, desc.height, 1};
  const VkImageLayout read = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier(cmd, layoutChange(image, layout, read));
  vkCmdCopyImageToBuffer(cmd, image.handle(), read, to.handle(), 1, &region);
  barrier(cmd, layoutChange(image, read, layout));
}

void copyBuffer(VkCommandBuffer cmd, const gpu::Buffer& buffer, uint64_t bytes, const gpu::Buffer& to) {
  constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  gpu::memoryBarrier(cmd, kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                     VK_ACCESS_2_TRANSFER_READ_BIT);
  const VkBufferCopy region{0, 0, bytes};
  vkCmdCopyBuffer(cmd, buffer.handle(), to.handle(), 1, &region);
  gpu::memoryBarrier(cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, kAll,
                     VK_ACCESS_2_MEMORY_WRITE_BIT);
}

}  // namespace

void FrameSlot::setObserved(const std::vector<Observation>& observations, const PassInstances& instances) {
  std::vector<Observed> chosen;
  const BoundGraph& graph = *state.plan->graph;
  for (const Observation& what : observations) {
    const bool runs = std::any_of(instances.begin(), instances.end(),
                                  [&](const auto& pass) { return pass->index == what.pass; });
    if (!runs)
      throw Error(ExitCode::BadInput, "`" + what.name + "` cannot be observed: its pass does not run",
                  "wire one of the outputs of the pass");
    const BoundResource& resource = graph.resources[graph.passes[what.pass].accesses[what.access].resource];
    const ResourceDesc& all = resource.desc;
    const bool image = all.kind == ResourceKind::Image;
    if (image && !resource.observable)
      throw Error(ExitCode::BadInput, "`" + what.name + "` cannot be observed",
                  "bind the graph as observable");
    if (image && (what.mip >= all.mips || what.layer >= std::max(all.depth, all.layers)))
      throw Error(ExitCode::BadInput, "`" + what.name + "` has no such mip or layer");
    ResourceDesc desc = observedPart(all, what);
    const uint64_t bytes = std::max<uint64_t>(16, resourceBytes(desc));
    chosen.push_back(
        {what,
         gpu::Buffer(*state.device, {"readback of " + what.name, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     gpu::MemoryKind::Readback}),
         std::move(desc)});
  }
  observed = std::move(chosen);
}

void FrameSlot::recordObserved(VkCommandBuffer cmd, const PassInstance& pass) {
  for (const Observed& o : observed) {
    if (o.what.pass != pass.index) continue;
    const bool timed = state.stepTimestamps >= 2;
    if (timed) {
      state.stepTimestamps -= 2;
      observeTimes.push_back(writeTimestamp(state, cmd));
    }
    const Access& access = pass.bound->accesses[o.what.access];
    if (o.desc.kind == ResourceKind::Image)
      copyImage(cmd, state.image(access), access.layout, o.what, o.desc, o.buffer);
    else
      copyBuffer(cmd, state.buffer(access), resourceBytes(o.desc), o.buffer);
    if (timed) observeTimes.push_back(writeTimestamp(state, cmd));
  }
}

void FrameSlot::recordCopy(VkCommandBuffer cmd, const OutputCopy& copy) {
  const uint32_t resource = outputResource(*state.plan->graph, copy.output);
  const BoundResource& r = state.plan->graph->resources[resource];
  const gpu::Image& from = state.resources[resource].images[r.history ? state.parity : 0];
  VkImageMemoryBarrier2 change = layoutChange(from, VK_IMAGE_LAYOUT_UNDEFINED, kWritten);
  change.image = copy.image;
  change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, copy.layer, 1};
  barrier(cmd, change);
  VkImageCopy region{};
  region.srcSubresource = {from.aspect(), 0, 0, 1};
  region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, copy.layer, 1};
  region.extent = {r.desc.width, r.desc.height, 1};
  vkCmdCopyImage(cmd, from.handle(), state.plan->endLayout[resource], copy.image, kWritten, 1, &region);
  std::swap(change.oldLayout, change.newLayout);
  change.newLayout = copy.layout;
  barrier(cmd, change);
}

}  // namespace fovea::graph
