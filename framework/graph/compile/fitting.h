// Finds the values of parameters with which a graph can be bound, for messages, `fovea describe` and the viewer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/graph/compile/compile.h"

namespace fovea::graph {

// bind(), with or without the values that would fit in its messages.
BoundGraph bind(const Description& description, const Environment& environment, Diagnostics& diagnostics,
                bool suggest);

// The description with another value of a graph parameter, as from the command line.
Description withValue(const Description& description, uint32_t parameter, const std::string& text);
// The same for a parameter of a pass, which takes the place of what the graph gives it.
Description withValue(const Description& description, uint32_t pass, const std::string& name,
                      const std::string& text);

// What a type has before the graph parameter that it ends in: "blur-" of "blur-$kernel".
std::string startOfType(const PassDescription& pass);
// The texts that may stand for the parameter at the end of the types of passes, "blur-$kernel".
std::vector<std::string> typeEndings(const Description& description, const Registry& registry,
                                     uint32_t parameter);
// Those of `texts` with which the graph can be bound as well as it can be without this parameter's mistakes: no error is
// added to `known`.
std::vector<std::string> fittingValues(const Description& description, const Environment& environment,
                                       uint32_t parameter, const std::vector<std::string>& texts,
                                       const Diagnostics& known = {});

// The common ground of several parameters that take the same value: what all of them allow. Nothing if there is none,
// because one is a number and another a text, for instance.
std::optional<ParameterSpec> commonSpec(const std::vector<const ParameterSpec*>& specs);
// What a parameter allows, in words: "a whole number from 1 to 10", "one of disc, clamp".
std::string describeAllowed(const ParameterSpec& spec);

}  // namespace fovea::graph
