// What passes reservoirs-visibility-host and reservoirs-visibility-device have in common: ports, parameters and counters.
#pragma once

#include <string>

#include "fovea/pass.h"

namespace fovea::passes {

// How the pass uses images and lists of reservoirs that it reads, and its output.
void declareReservoirsVisibility(graph::PassDeclaration& d, graph::Usage images, graph::Usage lists,
                                 graph::Usage write);
// Throws Error(BadInput) if the sizes of the inputs do not fit each other.
void checkReservoirsVisibility(const graph::PassContext& ctx);

}  // namespace fovea::passes
