// The commands that a plan leads to, as far as it says so.
#pragma once

#include <optional>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

// What a pass of this level records in every frame: the commands of its declared steps and the barriers between them,
// and if it is the first pass of the level, the one before it. Unknown for passes that decide in each frame what to
// record, for those that work on the host, and if the plan was made without shaders.
std::optional<CommandCounts> plannedCommands(const Plan& plan, const Level& level, uint32_t pass);

}  // namespace fovea::graph
