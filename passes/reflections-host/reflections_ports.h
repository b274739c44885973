// What passes reflections-host and reflections-device have in common: ports, parameters and counters.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "fovea/pass.h"

namespace fovea::passes {

// read, write: how the pass uses its input and its outputs.
void declareReflections(graph::PassDeclaration& d, graph::Usage read, graph::Usage write);
// Throws Error(BadInput) if the mirrors are those of another view. half: half the size of the pass's view, rounded up.
void checkReflections(const graph::PassContext& ctx, glm::uvec2 half);

}  // namespace fovea::passes
