// JSON schema of graph files, generated from the pass registry: an editor completes pass types, ports and
// parameters and shows their docs, defaults and ranges.
#pragma once

#include <string>

#include "framework/graph/pass/registry.h"

namespace fovea::graph {

// Draft 7, as editors know it. It describes single files: what `extends` brings in is not seen, so nothing
// but the shape of what is there can be required.
std::string generateSchema(const Registry& registry);

}  // namespace fovea::graph
