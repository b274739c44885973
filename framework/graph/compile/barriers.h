// Barriers: what must be waited for, made visible and brought into another layout before each level.
#pragma once

#include "framework/graph/compile/schedule.h"

namespace fovea::graph {

// Fills levels, end, startLayout and endLayout of a plan whose placements are made. The plan repeats every
// frame, so the state at its end is the state at its start: a first round finds that state, the last one
// writes the barriers.
//
// - All readers of one version, whatever their level, are served by one barrier in front of the first of
// them.
// - Memory hazards of a level merge into one global barrier; an image has a barrier of its own only when its
// layout
//   changes.
// - The first write to a transient resource waits for whatever used its memory before, in this frame or the
// last, and
//   discards the contents (UNDEFINED).
void placeBarriers(const BoundGraph& graph, const Schedule& schedule, const std::vector<Interval>& intervals,
                   Plan& plan);

}  // namespace fovea::graph
