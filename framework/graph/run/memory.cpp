// Device memory of a plan: aliased heaps for transient resources, separate memory for all others.
#include <algorithm>

#include "fovea/error.h"
#include "framework/base/paths.h"
#include "framework/gpu/format.h"
#include "framework/gpu/packed_mips.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/run/execute.h"
#include "framework/graph/run/execute_state.h"

namespace fovea::graph {
namespace {

constexpr uint32_t kShaderBufferUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

bool has(uint32_t usage, Usage bit) { return (usage & uint32_t(bit)) != 0; }

void makePlaced(ExecutorState& state, const Placement& placement) {
  const BoundResource& resource = state.plan->graph->resources[placement.resource];
  PhysicalResource& physical = state.resources[placement.resource];
  VkDeviceMemory memory = state.heaps[placement.heap];
  if (resource.desc.kind == ResourceKind::Image)
    physical.images[0] = gpu::Image(*state.device, imageDesc(resource), memory, placement.offset);
  else
    physical.buffers[0] = gpu::Buffer(*state.device, bufferDesc(resource), memory, placement.offset);
}

void makeOwned(ExecutorState& state, uint32_t index) {
  const BoundResource& resource = state.plan->graph->resources[index];
  PhysicalResource& physical = state.resources[index];
  for (uint32_t copy = 0; copy < (resource.history ? 2u : 1u); ++copy) {
    if (resource.desc.kind == ResourceKind::Image)
      physical.images[copy] = gpu::Image(*state.device, imageDesc(resource));
    else
      physical.buffers[copy] = gpu::Buffer(*state.device, bufferDesc(resource));
  }
}

void pipelineBarrier(VkCommandBuffer cmd, const std::vector<VkImageMemoryBarrier2>& images) {
  VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  all.srcAccessMask = all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &all;
  info.imageMemoryBarrierCount = static_cast<uint32_t>(images.size());
  info.pImageMemoryBarriers = images.data();
  vkCmdPipelineBarrier2(cmd, &info);
}

void clearImage(VkCommandBuffer cmd, const gpu::Image& image) {
  const VkImageSubresourceRange range = wholeImage(image);
  if (image.aspect() & VK_IMAGE_ASPECT_DEPTH_BIT) {
    const VkClearDepthStencilValue zero{};
    vkCmdClearDepthStencilImage(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &zero, 1, &range);
  } else {
    const VkClearColorValue zero{};
    vkCmdClearColorImage(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &zero, 1, &range);
  }
}

// Brings images that were taken over into the layouts in which this plan expects them.
void keepContents(const ExecutorState& state, uint32_t resource,
                  std::vector<VkImageMemoryBarrier2>& barriers) {
  const BoundResource& bound = state.plan->graph->resources[resource];
  if (bound.desc.kind != ResourceKind::Image) return;
  for (uint32_t copy = 0; copy < (bound.history ? 2u : 1u); ++copy) {
    const uint32_t role = bound.history && copy != state.parity ? 1 : 0;
    const VkImageLayout from = (*state.adopted[resource])[role], to = state.plan->startLayout[resource][role];
    if (from != to && to != VK_IMAGE_LAYOUT_UNDEFINED)
      barriers.push_back(layoutChange(state.resources[resource].images[copy], from, to));
  }
}

bool zeroedAtReset(const BoundResource& resource, bool scene) {
  if (resource.external) return false;
  if (resource.history) return scene || resource.lifetime != Lifetime::Scene;
  return resource.lifetime == Lifetime::View || (scene && resource.lifetime == Lifetime::Scene);
}

}  // namespace

VkImageSubresourceRange wholeImage(const gpu::Image& image) {
  return {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
}

std::vector<VkBufferImageCopy> packedCopy(const gpu::Image& image) {
  uint64_t all = UINT64_MAX;
  return gpu::packedMips(image, all);
}

uint64_t resourceBytes(const ResourceDesc& d) {
  if (d.kind == ResourceKind::Buffer) return uint64_t(d.stride) * d.count;
  uint64_t texels = 0;
  for (uint32_t mip = 0; mip < d.mips; ++mip)
    texels +=
        uint64_t(std::max(1u, d.width >> mip)) * std::max(1u, d.height >> mip) * std::max(1u, d.depth >> mip);
  return texels * d.layers * gpu::formatInfo(d.format).bytesPerTexel;
}

VkImageMemoryBarrier2 layoutChange(const gpu::Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  b.srcStageMask = b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  b.srcAccessMask = b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.oldLayout = from;
  b.newLayout = to;
  b.image = image.handle();
  b.subresourceRange = wholeImage(image);
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  return b;
}

gpu::BufferDesc bufferDesc(const BoundResource& resource) {
  gpu::BufferDesc desc;
  desc.name = resource.name;
  // The size is never 0 and always a multiple of 4, so that vkCmdFillBuffer reaches the whole buffer.
  desc.bytes = std::max<uint64_t>(16, (resourceBytes(resource.desc) + 3) / 4 * 4);
  desc.usage = kShaderBufferUsage;
  if (has(resource.usage, Usage::Uniform)) desc.usage |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
  if (has(resource.usage, Usage::TexelRead)) desc.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
  if (has(resource.usage, Usage::Indirect)) desc.usage |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
  return desc;
}

gpu::ImageDesc imageDesc(const BoundResource& resource) {
  const ResourceDesc& r = resource.desc;
  gpu::ImageDesc desc;
  desc.name = resource.name;
  desc.type = r.volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  desc.format = r.format;
  desc.width = r.width;
  desc.height = r.height;
  desc.depth = r.depth;
  desc.layers = r.layers;
  desc.mips = r.mips;
  desc.array = r.array;
  desc.linear = resource.shared;
  const uint32_t u = resource.usage;
  if (has(u, Usage::Sampled)) desc.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  if (has(u, Usage::StorageRead) || has(u, Usage::StorageWrite)) desc.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  if (has(u, Usage::ColorAttachment)) desc.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (has(u, Usage::DepthAttachment)) desc.usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (has(u, Usage::TransferRead) || has(u, Usage::HostRead) || resource.output || resource.observable)
    desc.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const bool zeroed = resource.history || resource.lifetime != Lifetime::Transient;
  if (has(u, Usage::TransferWrite) || has(u, Usage::HostWrite) || zeroed || resource.external)
    desc.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return desc;
}

MemoryNeed deviceMemory(gpu::Device& device, const BoundResource& resource) {
  const VkMemoryRequirements r = resource.desc.kind == ResourceKind::Image
                                     ? gpu::memoryRequirements(device, imageDesc(resource))
                                     : gpu::memoryRequirements(device, bufferDesc(resource));
  return {r.size, r.alignment, r.memoryTypeBits};
}

void addShaderFolders(gpu::ShaderCompiler& compiler, const Registry& registry) {
  for (const auto& path : shaderFolders()) compiler.addSearchPath(path);
  for (const auto& path : registry.pluginShaderPaths()) compiler.addSearchPath(path);
}

CompileOptions deviceCompileOptions(gpu::Device& device, std::shared_ptr<const BoundGraph> graph) {
  CompileOptions options;
  options.granularity = device.limits().bufferImageGranularity;
  options.memory = [&device, graph](uint32_t resource) {
    return deviceMemory(device, graph->resources[resource]);
  };
  addShaderFolders(device.shaders(), Registry::global());
  options.shaders = [&device](const std::string& file, const gpu::Defines& defines) {
    return device.shaders().compile(file, defines);
  };
  return options;
}

void replaceFormats(const gpu::Device& device, BoundGraph& graph) {
  if (!device.lacks("VK_FORMAT_R16G16_SNORM")) return;
  for (BoundResource& resource : graph.resources)
    if (resource.desc.format == VK_FORMAT_R16G16_SNORM) resource.desc.format = VK_FORMAT_R32G32_SFLOAT;
}

void shareWithHost(const gpu::Device& device, BoundGraph& graph) {
  if (!device.sharesMemory()) return;
  for (BoundResource& resource : graph.resources) {
    const ResourceDesc& d = resource.desc;
    const bool plain =
        d.kind == ResourceKind::Buffer || (!d.volume && !d.array && d.layers == 1 && d.mips == 1 &&
                                           gpu::supportsLinear(device, imageDesc(resource)));
    resource.shared = resource.onHost && plain;
  }
}

Environment deviceEnvironment(const gpu::Device* device) {
  Environment environment;
  if (device) {
    const VkPhysicalDeviceLimits& limits = device->limits();
    environment.maxImageDimension2D = limits.maxImageDimension2D;
    environment.maxImageDimension3D = limits.maxImageDimension3D;
    environment.maxImageArrayLayers = limits.maxImageArrayLayers;
    environment.maxStorageBufferRange = limits.maxStorageBufferRange;
    environment.maxUniformBufferRange = limits.maxUniformBufferRange;
  }
  return environment;
}

void allocateResources(ExecutorState& state) {
  const Plan& plan = *state.plan;
  state.resources.resize(plan.graph->resources.size());
  state.adopted.assign(plan.graph->resources.size(), std::nullopt);
  for (size_t i = 0; i < plan.heaps.size(); ++i) {
    state.heaps.push_back(state.device->allocate(plan.heaps[i].bytes, plan.heaps[i].memoryTypeBits,
                                                 VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                                 "transient resources of graph " + plan.graph->name));
  }
  std::vector<bool> placed(state.resources.size(), false);
  for (const Placement& placement : plan.placements) {
    makePlaced(state, placement);
    placed[placement.resource] = true;
  }
  for (uint32_t i = 0; i < state.resources.size(); ++i)
    if (plan.resourceLive[i] && !placed[i]) makeOwned(state, i);
}

void freeResources(ExecutorState& state) {
  state.resources.clear();
  for (const VkDeviceMemory heap : state.heaps) state.device->release(heap);
  state.heaps.clear();
}

void resetKeptResources(ExecutorState& state, VkCommandBuffer cmd) {
  if (state.started && !state.cameraCut) return;
  const Plan& plan = *state.plan;
  std::vector<VkImageMemoryBarrier2> before, after;
  std::vector<const gpu::Image*> images;
  std::vector<const gpu::Buffer*> buffers;
  for (uint32_t i = 0; i < state.resources.size(); ++i) {
    const BoundResource& resource = plan.graph->resources[i];
    if (!plan.resourceLive[i]) continue;
    const bool fresh = !state.started && !state.adopted[i];
    const bool zeroed =
        fresh ? zeroedAtReset(resource, true) : state.cameraCut && zeroedAtReset(resource, false);
    if (!zeroed) {
      if (!state.started && state.adopted[i]) keepContents(state, i, after);
      continue;
    }
    for (uint32_t copy = 0; copy < (resource.history ? 2u : 1u); ++copy) {
      if (resource.desc.kind == ResourceKind::Buffer) {
        buffers.push_back(&state.resources[i].buffers[copy]);
        continue;
      }
      const gpu::Image& image = state.resources[i].images[copy];
      // The current copy of a history image has index `parity`.
      const bool previous = resource.history && copy != state.parity;
      const VkImageLayout start = plan.startLayout[i][previous ? 1 : 0];
      images.push_back(&image);
      before.push_back(layoutChange(image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL));
      if (start != VK_IMAGE_LAYOUT_UNDEFINED)
        after.push_back(layoutChange(image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, start));
    }
  }
  if (images.empty() && buffers.empty() && after.empty()) return;
  pipelineBarrier(cmd, before);
  for (const gpu::Image* image : images) clearImage(cmd, *image);
  for (const gpu::Buffer* buffer : buffers) vkCmdFillBuffer(cmd, buffer->handle(), 0, VK_WHOLE_SIZE, 0);
  pipelineBarrier(cmd, after);
}

}  // namespace fovea::graph
