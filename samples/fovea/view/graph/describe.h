// A running graph as JSON for the page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "framework/graph/run/execute.h"
#include "framework/session/graph_run.h"
#include "samples/fovea/view/graph/changes.h"

namespace fovea::view {

// Passes with parameters and ports, edges, outputs, graph parameters and memory.
nlohmann::json describeGraph(const graph::Plan& plan, const graph::Description& description,
                             const graph::Environment& environment, const Documents& documents,
                             const Changes& changes, const graph::ElementTypes& types);

// The outputs of a graph, each with the source that shows it.
nlohmann::json describeOutputs(const graph::BoundGraph& graph);

// Times of one frame: for each pass of the graph that ran its GPU and CPU milliseconds, and the counters.
nlohmann::json describeTimes(const graph::FrameResult& frame);

// The text of what goes to a page. Files may hold bytes that are no UTF-8; those are replaced.
std::string textOf(const nlohmann::json& json);

// Messages, each with the line of the file that it is about.
nlohmann::json describeMessages(const std::vector<Diagnostic>& messages);

}  // namespace fovea::view
