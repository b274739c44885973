// What passes know of the materials of the frame (`view.materials`): whether surfaces are diffuse, or all that glTF says.
#pragma once

#include "fovea/pass.h"

namespace fovea::passes {

bool fullMaterials(const graph::Parameters& parameters);
// 0 or 1.
graph::SizeExpr fullMaterials();
// Requires that the input `gbuffer`, if it is wired, holds the materials if they are full; one of no pass may not.
void requireMaterials(graph::PassDeclaration& d);

}  // namespace fovea::passes
