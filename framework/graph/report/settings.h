// What can be set of a graph from outside, and to which values: for `fovea describe` and for the controls of the viewer.
#pragma once

#include <string>
#include <vector>

#include "framework/graph/compile/compile.h"

namespace fovea::graph {

// A parameter of the graph or of a sub-graph.
struct Setting {
  std::string name;   // as in --set: "vpl_count", "right.kernel"
  std::string value;  // as in --set; "$scene.environment" where the scene says it
  // What every place that takes the parameter allows. Only those choices are listed with which this graph can be bound,
  // as a strategy may lack a port to which something is wired.
  ParameterSpec spec;
  std::vector<std::string> reaches;  // "blur.radius"; "blur" where it chooses the type of that pass
  uint32_t parameter = 0;            // Description::graphParameters
};
std::vector<Setting> settings(const Description& description, const Environment& environment);
// The same with all choices that the passes declare, also of a part that is no graph by itself.
std::vector<Setting> declaredSettings(const Description& description, const Registry& registry);

// What a parameter of a pass allows, with only those choices with which this graph can be bound.
ParameterSpec fittingSpec(const Description& description, const Environment& environment, uint32_t pass,
                          const ParameterSpec& spec);

// A value as --set takes it.
std::string valueText(const Value& value);

}  // namespace fovea::graph
