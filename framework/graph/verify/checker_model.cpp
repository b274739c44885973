#include "framework/graph/verify/checker_model.h"

namespace fovea::graph::checker {

StageSet stageSet(VkPipelineStageFlags2 stages) {
  constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT |
                                              VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;
  if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) stages |= kTransfer;
  StageSet set = 0;
  for (int i = 0; i < kStageCount; ++i)
    if (stages & (kStages[i] | VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)) set |= 1u << i;
  return set;
}

bool inFirstScope(const Event& event, const Scope& scope) {
  return ((event.stage | event.after) & scope.src) != 0;
}

bool flushed(const Event& event, const Scope& scope) {
  return event.available ||
         ((event.stage & scope.src) != 0 && (event.access & scope.srcAccess) == event.access);
}

void applyBarrier(Event& event, const Scope& scope) {
  if (!inFirstScope(event, scope)) return;
  if (event.write && flushed(event, scope)) {
    event.available = true;
    for (int i = 0; i < kStageCount; ++i)
      if (scope.dst >> i & 1) event.seen[static_cast<size_t>(i)] |= scope.dstAccess;
  }
  event.after |= scope.dst;
}

bool ordered(const Event& event, const Need& need) { return (need.stages & ~event.after) == 0; }

bool visible(const Event& event, const Need& need) {
  if (!event.write) return true;
  for (int i = 0; i < kStageCount; ++i)
    if ((need.stages >> i & 1) && (need.access & ~event.seen[static_cast<size_t>(i)])) return false;
  return true;
}

std::vector<Event> eventsOf(const Need& need) {
  std::vector<Event> events;
  for (int i = 0; i < kStageCount; ++i) {
    if (!(need.stages >> i & 1)) continue;
    Event event;
    event.stage = 1u << i;
    event.access = need.access;
    event.write = need.write;
    events.push_back(event);
  }
  return events;
}

}  // namespace fovea::graph::checker
