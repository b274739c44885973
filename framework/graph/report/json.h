// What passes and graphs are, as JSON for programs: `--json` of the commands, and the pages of the viewer.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "framework/graph/compile/compile.h"
#include "framework/graph/report/settings.h"

namespace fovea::graph {

const char* nameOf(PassKind kind);  // "compute", "graphics", "compute and graphics", "host"

nlohmann::json valueJson(const Value& value);
// Its name, doc, type, default, unit, and `min` and `max` or `choices`.
nlohmann::json specJson(const ParameterSpec& spec);
// Ports, parameters, counters and steps of a pass type.
nlohmann::json passTypeJson(const PassDeclaration& declaration);
// A graph's story: its settings, its passes in order with what they move, and its memory.
nlohmann::json graphJson(const Description& description, const Environment& environment, const Plan& plan);

}  // namespace fovea::graph
