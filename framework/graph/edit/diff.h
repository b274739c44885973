// What differs in meaning between two graphs, however they are written.
#pragma once

#include <string>
#include <vector>

#include "framework/graph/compile/plan.h"

namespace fovea::graph {

// A line for each difference between two plans: passes and their types, wiring, parameters, what belongs to the frame,
// outputs, resources, the order of passes, and memory. Empty if both do the same.
std::vector<std::string> differences(const Plan& before, const Plan& after);

}  // namespace fovea::graph
