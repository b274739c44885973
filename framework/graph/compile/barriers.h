// Barriers: what must be waited for, made visible and moved to another layout before each level.
#pragma once

#include "framework/graph/compile/schedule.h"

namespace fovea::graph {

// Fills in levels, end, startLayout and endLayout of a plan whose placements are made. The plan repeats every frame, so
// the state at its end is the state at its start: a first round finds that state, and the last one writes the barriers.
//
// - All readers of one version, whatever their levels, are served by one barrier before the first of them.
// - The memory hazards of a level are merged into one global barrier; an image has a barrier of its own
//   only if its layout changes.
// - The first write to a transient resource waits for whatever used its memory before, in this frame or the last, and
//   discards the contents (UNDEFINED).
void placeBarriers(const BoundGraph& graph, const Schedule& schedule, const std::vector<Interval>& intervals,
                   Plan& plan);

}  // namespace fovea::graph
