// Formats a plan for people and tools: as text, for Graphviz, and as JSON.
#pragma once

#include <string>

#include "fovea/document.h"
#include "framework/graph/compile/plan.h"

namespace fovea::graph {

// Text: levels with their barriers and passes, every resource with its size, lifetime and placement, and memory totals.
std::string planText(const Plan& plan);
// Graphviz: passes as boxes (culled ones dashed), edges labelled with the resources that they
// carry, history edges dashed.
std::string planDot(const Plan& plan);
// The same facts as JSON, for programs.
std::string planJson(const Plan& plan);

std::string writePlan(const Plan& plan, PlanForm form);

// "64x32 rgba16f", "128x128x1000 d32f (array)", "1000 x 64 B Light"
std::string describe(const ResourceDesc& desc);
// "12.5 MiB"
std::string printBytes(uint64_t bytes);

}  // namespace fovea::graph
