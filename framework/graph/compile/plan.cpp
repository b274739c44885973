#include "framework/graph/compile/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "framework/base/hash.h"
#include "framework/gpu/format.h"
#include "framework/graph/compile/alias.h"
#include "framework/graph/compile/barriers.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/compile/scratch.h"
#include "framework/graph/pass/validate.h"

namespace fovea::graph {

namespace {

VkPipelineStageFlags2 shaderStages(PassKind kind) {
  constexpr VkPipelineStageFlags2 kGraphics =
      VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  switch (kind) {
    case PassKind::Compute:
      return VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    case PassKind::Graphics:
      return kGraphics;
    case PassKind::ComputeAndGraphics:
      return kGraphics | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    case PassKind::Host:
      return 0;
  }
  return 0;
}

}  // namespace

VkImageLayout accessLayout(Usage usage, bool reads, bool writes) {
  if (any(usage, Usage::HostWrite) && reads) return VK_IMAGE_LAYOUT_GENERAL;
  auto only = [&](Usage set) { return (uint32_t(usage) & ~uint32_t(set)) == 0; };
  if (usage == Usage::None) return VK_IMAGE_LAYOUT_UNDEFINED;
  if (only(Usage::Sampled)) return VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  if (only(Usage::ColorAttachment)) return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  if (only(Usage::DepthAttachment) && writes) return VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  // Depth that is tested against and sampled at the same time, but not written.
  if (only(Usage::DepthAttachment | Usage::Sampled) && !writes)
    return VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  if (only(Usage::TransferRead | Usage::HostRead)) return VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  if (only(Usage::TransferWrite | Usage::HostWrite)) return VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  return VK_IMAGE_LAYOUT_GENERAL;
}

AccessScope accessScope(PassKind kind, Usage usage, bool reads, bool writes) {
  AccessScope scope;
  const VkPipelineStageFlags2 shaders = shaderStages(kind);
  auto add = [&](Usage bit, VkPipelineStageFlags2 stage, VkAccessFlags2 access) {
    if (!any(usage, bit)) return;
    scope.stage |= stage;
    scope.access |= access;
  };
  add(Usage::Sampled, shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
  add(Usage::StorageRead, shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
  add(Usage::StorageWrite, shaders, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  add(Usage::Uniform, shaders, VK_ACCESS_2_UNIFORM_READ_BIT);
  add(Usage::TexelRead, shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
  add(Usage::Indirect, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  add(Usage::ColorAttachment, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT);  // blending reads
  add(Usage::DepthAttachment,
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
          (writes ? VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT : 0));
  add(Usage::TransferRead | Usage::HostRead, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
      VK_ACCESS_2_TRANSFER_READ_BIT);
  add(Usage::TransferWrite | Usage::HostWrite, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
      VK_ACCESS_2_TRANSFER_WRITE_BIT);
  // A host pass that updates in place also copies out the old contents.
  if (any(usage, Usage::HostWrite) && reads) scope.access |= VK_ACCESS_2_TRANSFER_READ_BIT;
  scope.layout = accessLayout(usage, reads, writes);
  return scope;
}

// ---- Memory ------------------------------------------------------------------------------------------

MemoryNeed estimateMemory(const ResourceDesc& desc) {
  constexpr uint64_t kAlignment = 256;
  uint64_t bytes = 0;
  if (desc.kind == ResourceKind::Buffer) {
    bytes = desc.count * desc.stride;
  } else {
    const uint64_t texel = gpu::formatInfo(desc.format).bytesPerTexel;
    for (uint32_t mip = 0; mip < desc.mips; ++mip)
      bytes += uint64_t(std::max(1u, desc.width >> mip)) * std::max(1u, desc.height >> mip) *
               std::max(1u, desc.depth >> mip) * desc.layers * texel;
  }
  return {(bytes + kAlignment - 1) / kAlignment * kAlignment, kAlignment, ~0u};
}

// ---- Compile -----------------------------------------------------------------------------------------

Plan compile(std::shared_ptr<const BoundGraph> graph, const CompileOptions& options) {
  Plan plan;
  Schedule order = schedule(*graph, options.randomOrder);
  const std::vector<Interval> intervals = lifetimes(*graph, order);
  Hasher hash;
  hash.add(graph->hash);
  detail::Scratch scratch;
  detail::ScratchVector<AliasRequest> requests(scratch);
  requests.reserve(graph->resources.size());
  for (uint32_t r = 0; r < graph->resources.size(); ++r) {
    if (!order.resourceLive[r]) continue;
    const BoundResource& resource = graph->resources[r];
    if (resource.external) continue;
    const MemoryNeed need = options.memory ? options.memory(r) : estimateMemory(resource.desc);
    hash.add(need.bytes, need.alignment << 32 | need.memoryTypeBits);
    if (isTransient(resource))
      requests.push_back({r, intervals[r], need});
    else
      plan.bytesKept += need.bytes * (resource.history ? 2 : 1);
  }
  hash.add(options.granularity << 1 | options.alias);
  hash.add(options.randomOrder ? uint64_t(*options.randomOrder) + 1 : uint64_t(0));
  AliasResult placed = placeResources(requests, options.granularity, options.alias);
  plan.placements = std::move(placed.placements);
  plan.heaps = std::move(placed.heaps);
  plan.bytesAliased = placed.bytesAliased;
  plan.bytesUnaliased = placed.bytesUnaliased;
  placeBarriers(*graph, order, intervals, plan);
  plan.passLive = std::move(order.passLive);
  plan.resourceLive = std::move(order.resourceLive);
  plan.hash = hash.value();
  plan.graph = std::move(graph);
  return plan;
}

std::shared_ptr<const Plan> PlanCache::compile(std::shared_ptr<const BoundGraph> graph,
                                               const CompileOptions& options) {
  constexpr size_t kKept = 8;
  Hasher hash;
  hash.add(graph->hash);
  for (uint32_t r = 0; r < graph->resources.size() && options.memory; ++r) {
    if (graph->resources[r].external) continue;
    const MemoryNeed need = options.memory(r);
    hash.add(need.bytes, need.alignment << 32 | need.memoryTypeBits);
  }
  hash.add(options.granularity << 2 | uint64_t(options.alias) << 1 | uint64_t(bool(options.memory)));
  hash.add(options.randomOrder ? uint64_t(*options.randomOrder) + 1 : uint64_t(0));
  const uint64_t key = hash.value();
  for (auto at = plans_.begin(); at != plans_.end(); ++at) {
    if (at->first != key) continue;
    ++hits_;
    std::rotate(at, at + 1, plans_.end());
    return plans_.back().second;
  }
  if (plans_.size() >= kKept) plans_.erase(plans_.begin());
  auto plan = std::make_shared<const Plan>(graph::compile(std::move(graph), options));
  plans_.emplace_back(key, plan);
  return plan;
}

void warnAboutPlan(const Plan& plan, Diagnostics& diagnostics) {
  const BoundGraph& graph = *plan.graph;
  for (size_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.passLive[p])
      diagnostics.warning(
          {}, "passes." + graph.passes[p].name,
          fmt::format("pass `{}` does not run: nothing needs what it makes", graph.passes[p].name),
          "wire one of its outputs, or remove it");
}

}  // namespace fovea::graph
