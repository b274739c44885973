// What passes near-field-host and near-field-device have in common: ports, parameters and counters.
#pragma once

#include <string>

#include "fovea/pass.h"

namespace fovea::passes {

// read, write: how the pass uses its input and its outputs.
void declareNearField(graph::PassDeclaration& d, graph::Usage read, graph::Usage write);
// Throws Error(BadInput) if the blocks of pixels have no possible width.
void checkNearField(const graph::Parameters& parameters, const std::string& pass);

}  // namespace fovea::passes
