#include "framework/graph/compile/bound.h"

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
  // Storage buffers take the place of texel buffers on some devices.
  add(Usage::TexelRead, shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
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

}  // namespace fovea::graph
