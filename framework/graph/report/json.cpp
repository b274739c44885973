#include "framework/graph/report/json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/gpu/format.h"
#include "framework/graph/report/report.h"
#include "framework/graph/report/traffic.h"

namespace fovea::graph {

const char* nameOf(PassKind kind) {
  switch (kind) {
    case PassKind::Compute:
      return "compute";
    case PassKind::Graphics:
      return "graphics";
    case PassKind::ComputeAndGraphics:
      return "compute and graphics";
    case PassKind::Host:
      break;
  }
  return "host";
}

namespace {

const char* nameOf(ParameterSpec::Type type) {
  switch (type) {
    case ParameterSpec::Type::Bool:
      return "bool";
    case ParameterSpec::Type::Int:
      return "int";
    case ParameterSpec::Type::Real:
      return "real";
    case ParameterSpec::Type::Choice:
      return "choice";
    case ParameterSpec::Type::Text:
      break;
  }
  return "text";
}

const char* nameOf(Direction direction) {
  switch (direction) {
    case Direction::Input:
      return "in";
    case Direction::Output:
      return "out";
    case Direction::InOut:
      return "inout";
    case Direction::Scratch:
      break;
  }
  return "scratch";
}

const char* nameOf(Lifetime lifetime) {
  return lifetime == Lifetime::View ? "view" : lifetime == Lifetime::Scene ? "scene" : "frame";
}

nlohmann::json memberJson(const MemberSpec& member, bool sized) {
  const ResourceSpec& r = member.resource;
  nlohmann::json made{{"name", member.name}, {"doc", member.doc}};
  if (r.kind == ResourceKind::Buffer) {
    made.update({{"kind", "buffer"}, {"element", r.element}, {"stride", r.stride}});
    if (sized) made["count"] = r.count.print();
    return made;
  }
  made["kind"] = r.volume ? "volume" : r.array ? "image array" : "image";
  made["format"] = r.format == VK_FORMAT_UNDEFINED ? nlohmann::json(nullptr)
                                                   : nlohmann::json(gpu::formatInfo(r.format).name);
  if (!sized) return made;
  made.update({{"width", r.width.print()}, {"height", r.height.print()}, {"light", r.light}});
  if (r.volume) made["depth"] = r.depth.print();
  if (r.array) made["layers"] = r.layers.print();
  return made;
}

nlohmann::json portJson(const PortSpec& port) {
  nlohmann::json made{{"name", port.name},
                      {"doc", port.doc},
                      {"direction", nameOf(port.direction)},
                      {"optional", port.optional},
                      {"bundle", port.bundle.empty() ? nlohmann::json(nullptr) : nlohmann::json(port.bundle)},
                      {"members", nlohmann::json::array()}};
  for (const MemberSpec& member : port.members)
    made["members"].push_back(memberJson(member, port.direction != Direction::Input));
  if (port.direction == Direction::Output || port.direction == Direction::Scratch)
    made["kept_for"] = nameOf(port.lifetime);
  return made;
}

// The graph parameter from which a pass takes a value, if there is one.
std::optional<uint32_t> givenBy(const Description& description, uint32_t pass, const std::string& name) {
  const PassDescription& from = description.passes[pass];
  for (uint32_t i = 0; i < from.parameterCount; ++i) {
    const ParameterDescription& given = description.parameters[from.firstParameter + i];
    if (given.given->key == name) return given.from;
  }
  return std::nullopt;
}

// Passes in the order of their levels, with the bytes that each moves for a pixel of the picture.
nlohmann::json passesJson(const Description& description, const Environment& environment, const Plan& plan) {
  const BoundGraph& graph = *plan.graph;
  const std::vector<PassTraffic> moved = traffic(plan);
  const double pixels = static_cast<double>(std::max<uint64_t>(outputPixels(graph), 1));
  nlohmann::json list = nlohmann::json::array();
  for (size_t l = 0; l < plan.levels.size(); ++l) {
    for (const uint32_t p : plan.levels[l].passes) {
      const BoundPass& pass = graph.passes[p];
      nlohmann::json parameters = nlohmann::json::array();
      for (size_t i = 0; i < pass.declaration->parameters.size(); ++i) {
        const ParameterSpec& spec = pass.declaration->parameters[i];
        nlohmann::json parameter = specJson(fittingSpec(description, environment, p, spec));
        parameter["value"] = valueJson(pass.parameters.values()[i]);
        // What the graph gives to several passes is set there, as they may have to agree.
        if (const std::optional<uint32_t> from = givenBy(description, p, spec.name))
          parameter["given_by"] = description.graphParameters[*from].name();
        parameters.push_back(std::move(parameter));
      }
      list.push_back({{"name", pass.name},
                      {"type", pass.declaration->type},
                      {"doc", pass.declaration->doc},
                      {"level", l},
                      {"view", graph.views[pass.view]},
                      {"picture_bytes_per_pixel", static_cast<double>(moved[p].pictures.total()) / pixels},
                      {"other_bytes", moved[p].others.total()},
                      {"parameters", std::move(parameters)}});
    }
  }
  return list;
}

}  // namespace

nlohmann::json valueJson(const Value& value) {
  return std::visit([](const auto& v) { return nlohmann::json(v); }, value);
}

nlohmann::json specJson(const ParameterSpec& spec) {
  nlohmann::json made{{"name", spec.name},
                      {"doc", spec.doc},
                      {"type", nameOf(spec.type)},
                      {"default", valueJson(spec.defaultValue)}};
  if (std::isfinite(spec.min)) made["min"] = spec.min;
  if (std::isfinite(spec.max)) made["max"] = spec.max;
  if (spec.type == ParameterSpec::Type::Choice || !spec.choices.empty()) made["choices"] = spec.choices;
  if (!spec.unit.empty()) made["unit"] = spec.unit;
  return made;
}

nlohmann::json passTypeJson(const PassDeclaration& declaration) {
  nlohmann::json made{{"name", declaration.type},
                      {"doc", declaration.doc},
                      {"kind", nameOf(declaration.kind)},
                      {"looks_through_a_view", declaration.usesView},
                      {"traces_rays", declaration.tracesRays},
                      {"has_side_effects", declaration.sideEffects},
                      {"ports", nlohmann::json::array()},
                      {"parameters", nlohmann::json::array()},
                      {"counters", nlohmann::json::array()},
                      {"requirements", nlohmann::json::array()},
                      {"steps", nlohmann::json::array()}};
  for (const PortSpec& port : declaration.ports) made["ports"].push_back(portJson(port));
  for (const ParameterSpec& spec : declaration.parameters) made["parameters"].push_back(specJson(spec));
  for (const CounterSpec& c : declaration.counters)
    made["counters"].push_back({{"name", c.name}, {"doc", c.doc}});
  for (const RequirementSpec& r : declaration.requirements)
    made["requirements"].push_back(
        {{"condition", r.condition.print()}, {"otherwise", r.message}, {"remedy", r.remedy}});
  for (const StepSpec& step : declaration.steps)
    made["steps"].push_back(
        {{"name", step.name}, {"shader", step.shader}, {"condition", step.condition.print()}});
  return made;
}

nlohmann::json graphJson(const Description& description, const Environment& environment, const Plan& plan) {
  const BoundGraph& graph = *plan.graph;
  nlohmann::json made{
      {"name", graph.name}, {"description", graph.description}, {"parameters", nlohmann::json::array()}};
  for (const Setting& setting : settings(description, environment)) {
    nlohmann::json parameter = specJson(setting.spec);
    parameter.erase("default");
    parameter["name"] = setting.name;
    parameter["value"] = setting.value;
    parameter["reaches"] = setting.reaches;
    made["parameters"].push_back(std::move(parameter));
  }
  made["view"] = nlohmann::json::array();
  for (const ParameterSpec& spec : viewParameters()) {
    made["view"].push_back(specJson(spec));
    made["view"].back()["value"] = valueJson(*graph.view.find(spec.name));
  }
  made["passes"] = passesJson(description, environment, plan);
  made["culled"] = nlohmann::json::array();
  for (size_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.passLive[p]) made["culled"].push_back(graph.passes[p].name);
  made["outputs"] = nlohmann::json::object();
  for (const BoundOutput& o : graph.outputs)
    made["outputs"][o.name] = describe(graph.resources[o.resource].desc);
  made["memory"] = {{"transient", plan.bytesAliased},
                    {"transient_without_aliasing", plan.bytesUnaliased},
                    {"kept", plan.bytesKept}};
  return made;
}

}  // namespace fovea::graph
