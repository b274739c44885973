// What passes eye-paths-host and eye-paths-device have in common: outputs and parameters.
#pragma once

#include "fovea/pass.h"

namespace fovea::passes {

// write: how the pass uses its outputs; paths: how long the output of that name lives.
void declareEyePaths(graph::PassDeclaration& d, graph::Usage write, graph::Lifetime paths);

}  // namespace fovea::passes
