// Proves a plan free of hazards by playing several frames of it on a model of the memory. Shares no code with
// the phases that made the plan: stages, accesses and layouts come from its own tables, and it follows every
// single access instead of summed-up states.
#pragma once

#include <string>
#include <vector>

#include "framework/graph/compile/compile.h"

namespace fovea::graph {

struct CheckOptions {
  uint32_t frames = 4;  // at least 3, so that both copies of a history resource come round
  MemoryTable memory;   // what the plan was made with; empty: estimateMemory
};

// What is wrong, one sentence each; empty when the plan is sound. Found are:
// - an access that is not ordered after, or does not see, an earlier write (also of last frame, also of
// another resource
//   in the same memory), and a write that is not ordered after an earlier read
// - an image in another layout than the access needs or the barrier claims
// - contents read that nothing wrote, that another resource overwrote, or that are of another version or
// frame
// - memory too small, misaligned, out of its heap, or given to resources that must not share
// - passes missing, run twice, or run although culled
std::vector<std::string> checkPlan(const Plan& plan, const CheckOptions& options = {});

}  // namespace fovea::graph
