#include "framework/graph/edit/diff.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "framework/graph/compile/plan.h"
#include "framework/graph/report/report.h"
#include "framework/graph/report/settings.h"

namespace fovea::graph {
namespace {

// Facts by name, in alphabetical order: "blur.kernel" -> "disc".
using Facts = std::map<std::string, std::string>;

Facts passTypes(const Plan& plan) {
  Facts facts;
  for (const BoundPass& pass : plan.graph->passes) facts[pass.name] = pass.declaration->type;
  return facts;
}

Facts parameterValues(const Plan& plan) {
  Facts facts;
  for (const BoundPass& pass : plan.graph->passes)
    for (size_t i = 0; i < pass.declaration->parameters.size(); ++i)
      facts[pass.name + "." + pass.declaration->parameters[i].name] = valueText(pass.parameters.values()[i]);
  for (const ParameterSpec& spec : viewParameters())
    facts[std::string(kViewPrefix) + spec.name] = valueText(*plan.graph->view.find(spec.name));
  return facts;
}

// Which version of which resource each port reads or updates: the names of passes and ports say it for what passes make.
Facts wires(const Plan& plan) {
  Facts facts;
  for (const BoundPass& pass : plan.graph->passes)
    for (const Access& access : pass.accesses) {
      const PortSpec& port = pass.declaration->ports[access.port];
      if (port.direction != Direction::Input && port.direction != Direction::InOut) continue;
      const BoundResource& resource = plan.graph->resources[access.resource];
      std::string from = resource.external ? "inputs." + resource.name : resource.name;
      if (access.previous)
        from += "@previous";
      else if (access.reads && !access.writes && access.version > 1)
        from += fmt::format(" after {} updates", access.version - 1);
      facts[pass.name + "." + memberPath(port, port.members[access.member])] = std::move(from);
    }
  return facts;
}

Facts outputs(const Plan& plan) {
  Facts facts;
  for (const BoundOutput& o : plan.graph->outputs) facts[o.name] = plan.graph->resources[o.resource].name;
  return facts;
}

Facts resources(const Plan& plan) {
  Facts facts;
  for (size_t r = 0; r < plan.graph->resources.size(); ++r)
    if (plan.resourceLive[r]) facts[plan.graph->resources[r].name] = describe(plan.graph->resources[r].desc);
  return facts;
}

Facts levels(const Plan& plan) {
  Facts facts;
  for (size_t p = 0; p < plan.graph->passes.size(); ++p) facts[plan.graph->passes[p].name] = "does not run";
  for (size_t l = 0; l < plan.levels.size(); ++l)
    for (const uint32_t p : plan.levels[l].passes)
      facts[plan.graph->passes[p].name] = fmt::format("level {}", l);
  return facts;
}

Facts memory(const Plan& plan) {
  return {{"transient", printBytes(plan.bytesAliased)}, {"kept", printBytes(plan.bytesKept)}};
}

// Whether a fact belongs to one of these passes. If a pass itself is new or gone, its facts say nothing more.
bool isOf(const std::string& name, const Facts& passes) {
  for (size_t dot = name.rfind('.'); dot != std::string::npos && dot > 0; dot = name.rfind('.', dot - 1))
    if (passes.contains(name.substr(0, dot))) return true;
  return passes.contains(name);
}

Facts onlyIn(const Facts& one, const Facts& other) {
  Facts only;
  for (const auto& [name, value] : one)
    if (!other.contains(name)) only.emplace(name, value);
  return only;
}

}  // namespace

std::vector<std::string> differences(const Plan& before, const Plan& after) {
  const Facts typesBefore = passTypes(before), typesAfter = passTypes(after);
  const Facts gone = onlyIn(typesBefore, typesAfter), added = onlyIn(typesAfter, typesBefore);
  std::vector<std::string> lines;
  const auto compare = [&](const char* what, const Facts& a, const Facts& b) {
    for (const auto& [name, value] : a) {
      const auto other = b.find(name);
      if (other != b.end() && other->second != value)
        lines.push_back(fmt::format("{} {}: {} -> {}", what, name, value, other->second));
      else if (other == b.end() && (&a == &typesBefore || !isOf(name, gone)))
        lines.push_back(fmt::format("- {} {}: {}", what, name, value));
    }
    for (const auto& [name, value] : b)
      if (!a.contains(name) && (&b == &typesAfter || !isOf(name, added)))
        lines.push_back(fmt::format("+ {} {}: {}", what, name, value));
  };
  compare("pass", typesBefore, typesAfter);
  compare("wire", wires(before), wires(after));
  compare("parameter", parameterValues(before), parameterValues(after));
  compare("output", outputs(before), outputs(after));
  compare("resource", resources(before), resources(after));
  compare("plan", levels(before), levels(after));
  compare("memory", memory(before), memory(after));
  return lines;
}

}  // namespace fovea::graph
