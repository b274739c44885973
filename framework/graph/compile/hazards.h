// What separates two accesses to the same memory: the one rule behind the barriers between levels of a frame and
// between the steps of a pass.
#pragma once

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

// What has been done to one copy of a resource so far, as far as later accesses have to wait for it.
struct AccessHistory {
  VkPipelineStageFlags2 pendingStage = 0;  // a write that nothing has waited for yet
  VkAccessFlags2 pendingAccess = 0;
  VkPipelineStageFlags2 writeStage = 0;  // the last write, waited for or not
  VkAccessFlags2 writeAccess = 0;
  VkPipelineStageFlags2 readStage = 0;  // readers since then
  VkPipelineStageFlags2 seenStage = 0;  // where the contents are visible
  VkAccessFlags2 seenAccess = 0;
  // Stages that barriers have ordered after the last write, and after all readers since then; see settle().
  VkPipelineStageFlags2 afterWrite = 0, afterReads = 0;
  bool flushed = false;  // whether one of these barriers has made the write available
};

// Both return what has to be waited for before the access, and enter the access into the history. `scope` holds the
// stages and accesses of one access, or of several that one barrier serves.
Dependency beforeRead(AccessHistory& history, const AccessScope& scope);
// `reads` is true if the access also reads what was there before.
Dependency beforeWrite(AccessHistory& history, const AccessScope& scope, bool reads);
// Tells a history of a barrier, which may have been placed for other resources.
void settle(AccessHistory& history, const Dependency& barrier);

}  // namespace fovea::graph
