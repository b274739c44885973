// What passes near-field-pixels-host and near-field-pixels-device have in common: ports, parameters and counters.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "fovea/pass.h"

namespace fovea::passes {

// mask: members of the mask that the pass reads; read, change: how it uses its input and what it changes.
void declareNearFieldPixels(graph::PassDeclaration& d, std::vector<graph::MemberSpec> mask, graph::Usage read,
                            graph::Usage change);
// Throws Error(BadInput) if an image has another size than the view. size: of the view, pixels.
void checkNearFieldPixels(const graph::PassContext& ctx, glm::uvec2 size);

}  // namespace fovea::passes
