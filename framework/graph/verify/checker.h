// Verifies that a plan is free of hazards by simulating several frames of it on a model of the memory. The checker
// shares no code with the phases that make the plan: stages, accesses and layouts come from its own tables, and it
// follows every single access instead of accumulated states.
#pragma once

#include <string>
#include <vector>

#include "framework/graph/compile/compile.h"

namespace fovea::graph {

struct PlanCheckOptions {
  uint32_t frames = 4;  // at least 3, so that both copies of a history resource are used
  MemoryTable memory;   // the table that the plan was made with; estimateMemory if empty
};

// Returns one sentence per problem, or nothing if the plan is sound. It detects:
// - an access that is not ordered after an earlier write or does not see it (including writes of the last frame and
//   of another resource in the same memory), and a write that is not ordered after an earlier read
// - an image in another layout than the access needs or the barrier states
// - a read of contents that were never written, that another resource has overwritten, or that belong to another
//   version or frame
// - memory that is too small, misaligned, outside its heap, or given to resources that must not share it
// - passes that are missing, run twice, or run although they are culled
std::vector<std::string> checkPlan(const Plan& plan, const PlanCheckOptions& options = {});

}  // namespace fovea::graph
