// The parameters that somebody has changed while a graph runs, and how to keep them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/graph/compile/compile.h"

namespace fovea::view {

// Values by parameter, as `--set` takes them: {"vpl_count", "500"}, {"deferred.kernel", "disc"}.
using Changes = std::map<std::string, std::string>;

// {"vpl_count=500", ...}
std::vector<std::string> overridesOf(const Changes& changes);
// Later values of a name win. Throws Error(Usage) where there is no '='.
Changes changesOf(const std::vector<std::string>& overrides);

// A parameter of a graph, for the controls of a page.
struct GraphParameter {
  std::string name;
  const json::Value* written = nullptr;  // its value in the merged document
  // A parameter of a pass that takes its value from it and so says what it may be; nullptr if it is none that a pass
  // of this graph takes.
  const graph::ParameterSpec* spec = nullptr;
  std::vector<std::string> choices;  // of types of passes that end in it: "type": "vpl-intensity-$intensity"
};
// In the order of the document, which must outlive the list. `merged` is what graph::loadMerged() gives.
std::vector<GraphParameter> graphParameters(const json::Value& merged, const graph::Description& description,
                                            const graph::BoundGraph& bound);

// A graph file that extends `base` (a file in the same folder) by the changes alone. Throws Error(BadInput) naming a
// change that no such file can make, such as a parameter of a pass inside of a sub-graph.
std::string extendingGraph(const std::string& base, const Changes& changes, const json::Value& merged,
                           const graph::BoundGraph& bound);

}  // namespace fovea::view
