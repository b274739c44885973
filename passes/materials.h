// What passes know of the materials of the frame (`view.materials`): whether surfaces are diffuse, or all that glTF says.
#pragma once

#include "fovea/pass.h"

namespace fovea::passes {

bool fullMaterials(const graph::Parameters& parameters);
// 0 or 1.
graph::SizeExpr fullMaterials();
// Throws Error(BadInput) if materials are full, but the input `gbuffer` does not hold them, as it is no pass's.
void checkMaterials(const graph::PassContext& ctx);

}  // namespace fovea::passes
