// The JSON schema of graph files, generated from the pass registry. With it, an editor completes pass types, ports
// and parameters and shows their documentation, defaults and ranges.
#pragma once

#include <string>

#include "framework/graph/pass/registry.h"

namespace fovea::graph {

// JSON Schema draft 7, which editors support. The schema describes single files and cannot see what `extends` brings
// in, so it constrains only the shape of the members that are present.
std::string generateSchema(const Registry& registry);
// The schema of pass files, NAME.pass.json.
std::string passFileSchema();

}  // namespace fovea::graph
