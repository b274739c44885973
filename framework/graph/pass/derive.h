// What the steps of a pass say about it, where its file leaves it open.
#pragma once

#include "fovea/declaration.h"

namespace fovea::graph {

// Compute, graphics or both, by the steps.
void deriveKind(PassDeclaration& d);
// A port without usage may be used in every way that is natural for its direction, and as the steps use it.
void deriveUsages(PassDeclaration& d);

}  // namespace fovea::graph
