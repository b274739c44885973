// What passes probe-rays-host and probe-rays-device have in common: ports, parameters and counters.
#pragma once

#include <string>

#include "fovea/pass.h"

namespace fovea::passes {

// How the pass uses the images and the states of probes, and its output.
struct ProbeRayUsages {
  graph::Usage images, states, output;
};

void declareProbeRays(graph::PassDeclaration& d, ProbeRayUsages usages);
// Throws Error(BadInput) if the probes of the previous frame are not as many as the grid has room for.
void checkProbeRays(const graph::PassContext& ctx);

}  // namespace fovea::passes
