#include "framework/graph/compile/hazards.h"

namespace fovea::graph {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;

bool within(uint64_t bits, uint64_t set) { return (bits & ~set) == 0; }

bool sees(const AccessHistory& history, const AccessScope& scope) {
  return within(scope.stage, history.seenStage) && within(scope.access & ~kWrites, history.seenAccess);
}

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
  if (!sees(history, scope)) {
    // Earlier readers are named again, so that the contents are visible to every one of these accesses in every one
    // of these stages, which is what two masks can express.
    history.seenStage |= scope.stage;
    history.seenAccess |= scope.access;
    wait = dependency(history.writeStage, history.writeAccess, {history.seenStage, history.seenAccess});
  }
  history.pendingStage = 0;
  history.pendingAccess = 0;
  history.readStage |= scope.stage;
  history.afterReads = 0;
  return wait;
}

Dependency beforeWrite(AccessHistory& history, const AccessScope& scope, bool reads) {
  VkPipelineStageFlags2 source = 0;
  VkAccessFlags2 access = 0;
  if (!within(scope.stage, history.afterReads)) source |= history.readStage;
  const bool follows = history.flushed && within(scope.stage, history.afterWrite);
  if (!follows) {
    source |= history.pendingStage;
    access |= history.pendingAccess;
  }
  if (reads && !(follows && sees(history, scope))) {
    source |= history.writeStage;
    access |= history.writeAccess;
  }
  const bool written = history.writeStage != 0;
  history = {};
  history.pendingStage = history.writeStage = scope.stage;
  history.pendingAccess = history.writeAccess = scope.access & kWrites;
  Dependency wait = dependency(source, access, scope);
  // Readers have waited for the earlier write, and a chain of barriers leads from it to this one. That is a dependency
  // between writes only if it ends with this access.
  if (source && written) wait.dstAccess |= scope.access & kWrites;
  return wait;
}

// Barriers form chains: what one of them orders before a stage, the next one orders before more if it waits for that
// stage.
void settle(AccessHistory& history, const Dependency& barrier) {
  if (within(history.readStage, barrier.srcStage) || (history.afterReads & barrier.srcStage))
    history.afterReads |= barrier.dstStage;
  const bool waits = within(history.writeStage, barrier.srcStage);
  if (!waits && !(history.afterWrite & barrier.srcStage)) return;
  history.afterWrite |= barrier.dstStage;
  history.flushed |= waits && within(history.writeAccess, barrier.srcAccess);
  if (!history.flushed || !within(history.seenStage, barrier.dstStage) ||
      !within(history.seenAccess, barrier.dstAccess))
    return;
  history.seenStage = barrier.dstStage;
  history.seenAccess = barrier.dstAccess;
}

}  // namespace fovea::graph
