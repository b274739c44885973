// The parameters that were changed while a graph runs, and how to save them.
#pragma once

#include <filesystem>
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

// A graph's document with everything that it extends, and those of its sub-graphs by the names of their instances.
struct Documents {
  json::Value graph;
  std::map<std::string, json::Value> subGraphs;
};
// Throws as graph::loadMerged() does.
Documents loadDocuments(const std::filesystem::path& graph, const graph::LoadOptions& options);

// A parameter of a graph or of a sub-graph, for the controls of a page.
struct GraphParameter {
  std::string name;
  const json::Value* written =
      nullptr;  // its value in the documents: "$name" where the graph gives one of its own
  // A parameter of a pass that takes its value from it and so says what it may be; nullptr if no pass takes it.
  const graph::ParameterSpec* spec = nullptr;
};
// In the order of the document; the documents must outlive the list.
std::vector<GraphParameter> graphParameters(const Documents& documents, const graph::Description& description,
                                            const graph::BoundGraph& bound);
// The same of an instance of a sub-graph.
std::vector<GraphParameter> subGraphParameters(const std::string& instance, const Documents& documents,
                                               const graph::Description& description,
                                               const graph::BoundGraph& bound);

// A graph file that extends `base` (a file in the same folder) by the changes alone. Throws Error(BadInput) naming a
// change that no such file can make, such as a parameter of a pass inside of a sub-graph.
std::string extendingGraph(const std::string& base, const Changes& changes, const Documents& documents,
                           const graph::BoundGraph& bound);

}  // namespace fovea::view
