// The resources of a graph that can be shown, by name: an output of the graph ("image"), or a port of a pass
// ("gbuffer:gbuffer.normal"), followed by "@MIP.LAYER" where it has several.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "framework/graph/run/execute.h"

namespace fovea::view {

struct SourceName {
  std::string pass, path;  // pass is empty for an output of the graph
  uint32_t mip = 0, layer = 0;
};
// Whatever cannot be read is left for findSource() to refuse.
SourceName parseSource(std::string_view text);

// The observation that shows a source, named after it. Throws Error(BadInput) saying what there is instead.
graph::Observation findSource(const graph::Plan& plan, const std::string& source);

// The source that shows an output of the graph: the port of the pass that writes it last.
std::string sourceOfOutput(const graph::BoundGraph& graph, const graph::BoundOutput& output);
// "gbuffer:gbuffer.normal"
std::string sourceName(const graph::BoundPass& pass, const graph::Access& access);
// How a pass names what it accesses: "gbuffer.normal", "radiance".
std::string portPath(const graph::BoundPass& pass, const graph::Access& access);

}  // namespace fovea::view
