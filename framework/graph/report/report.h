// A plan for people and tools: text, Graphviz and JSON.
#pragma once

#include <string>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

// Levels with their barriers and passes, every resource with its size, life and place, and the memory totals.
std::string planText(const Plan& plan);
// Graphviz: passes as boxes (culled ones dashed), edges labelled with what flows, history edges dashed.
std::string planDot(const Plan& plan);
// The same facts for programs; layout in the README.
std::string planJson(const Plan& plan);

// "64x32 rgba16f", "128x128x1000 d32f (array)", "1000 x 64 B Vpl"
std::string describe(const ResourceDesc& desc);
// "12.5 MiB"
std::string printBytes(uint64_t bytes);

}  // namespace fovea::graph
