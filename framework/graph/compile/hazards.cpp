#include "framework/graph/compile/hazards.h"

namespace fovea::graph {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;

// Without a write to wait for, there is nothing to make visible.
Dependency dependency(VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess, const AccessScope& scope) {
  if (!srcStage) return {};
  return {srcStage, scope.stage, srcAccess, srcAccess ? scope.access : 0};
}

}  // namespace

Dependency& Dependency::operator|=(const Dependency& other) {
  srcStage |= other.srcStage;
  dstStage |= other.dstStage;
  srcAccess |= other.srcAccess;
  dstAccess |= other.dstAccess;
  return *this;
}

Dependency beforeRead(AccessHistory& history, const AccessScope& scope) {
  Dependency wait;
  if (scope.stage & ~history.seenStage || scope.access & ~history.seenAccess) {
    wait = dependency(history.writeStage, history.writeAccess, scope);
    history.seenStage |= scope.stage;
    history.seenAccess |= scope.access;
  }
  history.pendingStage = 0;
  history.pendingAccess = 0;
  history.readStage |= scope.stage;
  return wait;
}

Dependency beforeWrite(AccessHistory& history, const AccessScope& scope, bool reads) {
  VkPipelineStageFlags2 source = history.pendingStage | history.readStage;
  VkAccessFlags2 access = history.pendingAccess;
  if (reads) {
    source |= history.writeStage;
    access |= history.writeAccess;
  }
  history = {};
  history.pendingStage = history.writeStage = scope.stage;
  history.pendingAccess = history.writeAccess = scope.access & kWrites;
  return dependency(source, access, scope);
}

}  // namespace fovea::graph
