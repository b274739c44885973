// Barriers: what must be waited for, made visible or changed in layout before each level.
#pragma once

#include <array>
#include <vector>

#include "framework/graph/compile/plan.h"
#include "framework/graph/compile/schedule.h"

namespace fovea::graph {

struct Barriers {
  std::vector<Level> levels;
  BarrierBatch end;
  std::vector<std::array<VkImageLayout, 2>> startLayout;  // as in Plan
  std::vector<VkImageLayout> endLayout;
};

// The plan repeats every frame, so the state at its end is the state at its start: first rounds find that state, and
// the last one writes the barriers.
//
// - All readers of one version, whatever their levels, are served by one barrier before the first of them.
// - The memory hazards of a level are merged into one global barrier; an image has a barrier of its own
//   only if its layout changes.
// - The first write to a transient resource waits for whatever used its memory before, in this frame or the last, and
//   discards the contents (UNDEFINED).
Barriers placeBarriers(const BoundGraph& graph, const Schedule& schedule,
                       const std::vector<Interval>& intervals, const std::vector<Placement>& placements);

}  // namespace fovea::graph
