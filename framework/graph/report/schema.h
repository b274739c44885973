// The JSON schema of graph files, generated from the pass registry. With it, an editor completes pass types, ports
// and parameters and shows their documentation, defaults and ranges.
#pragma once

#include <string>
#include <vector>

#include "framework/graph/pass/registry.h"
#include "framework/graph/resolve/resolve.h"

namespace fovea::graph {

// A graph that files may extend.
struct KnownGraph {
  std::string name;  // "parts/vpl-base"
  Description description;
};

// JSON Schema draft 7, which editors support. A schema cannot read other files. Of a file that extends one of `graphs` it
// knows all the same which passes and parameters there are; of one that extends another, it constrains only the shape of
// the members that are present.
std::string generateSchema(const Registry& registry, const std::vector<KnownGraph>& graphs = {});
// The schema of pass files, NAME.pass.json.
std::string passFileSchema();

}  // namespace fovea::graph
