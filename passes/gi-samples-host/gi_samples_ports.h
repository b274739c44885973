// What passes gi-samples-host and gi-samples-device have in common: output, parameters and counters.
#pragma once

#include "fovea/pass.h"

namespace fovea::passes {

// write: how the pass uses its output.
void declareGiSamples(graph::PassDeclaration& d, graph::Usage write);

}  // namespace fovea::passes
