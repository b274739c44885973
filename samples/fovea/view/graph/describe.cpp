#include "samples/fovea/view/graph/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "framework/base/paths.h"
#include "framework/gpu/shader/shader.h"
#include "framework/graph/report/json.h"
#include "framework/graph/report/report.h"
#include "framework/session/sources.h"

namespace fovea::view {
namespace {

using Json = nlohmann::json;
using graph::BoundPass;
using graph::ParameterSpec;
using graph::specJson;
using graph::valueJson;

Json valueJson(const json::Value& value) {
  switch (value.type) {
    case json::Value::Type::Bool:
      return value.boolean;
    case json::Value::Type::Int:
      return value.integer;
    case json::Value::Type::Real:
      return value.real;
    case json::Value::Type::String:
      return value.string;
    default:
      return nullptr;
  }
}

// Of a pass that takes the value from a parameter of the graph, "$name".
std::string givenBy(const graph::Description& description, const std::string& pass,
                    const std::string& parameter) {
  for (const graph::PassDescription& p : description.passes) {
    if (p.name != pass) continue;
    for (uint32_t i = 0; i < p.parameterCount; ++i) {
      const graph::ParameterDescription& given = description.parameters[p.firstParameter + i];
      if (given.given && given.given->key == parameter && given.given->value.isString() &&
          given.given->value.string.starts_with("$"))
        return given.given->value.string.substr(1);
    }
  }
  return {};
}

Json parametersJson(const graph::Plan& plan, size_t number, const graph::Description& description,
                    const graph::Environment& environment, const Changes& changes) {
  Json list = Json::array();
  const BoundPass& pass = plan.graph->passes[number];
  const auto& specs = pass.declaration->parameters;
  for (size_t i = 0; i < specs.size(); ++i) {
    Json json = specJson(graph::fittingSpec(description, environment, uint32_t(number), specs[i]));
    json["value"] = valueJson(pass.parameters.values()[i]);
    json["changed"] = changes.contains(pass.name + "." + specs[i].name);
    const std::string given = givenBy(description, pass.name, specs[i].name);
    if (!given.empty()) json["given_by"] = given;
    list.push_back(std::move(json));
  }
  return list;
}

const char* directionName(graph::Direction direction) {
  switch (direction) {
    case graph::Direction::Input:
      return "in";
    case graph::Direction::Output:
      return "out";
    case graph::Direction::InOut:
      return "inout";
    case graph::Direction::Scratch:
      return "scratch";
  }
  return "in";
}

const char* typeName(gpu::ReflectedMember::Type type) {
  using Type = gpu::ReflectedMember::Type;
  return type == Type::Int ? "int" : type == Type::Uint ? "uint" : type == Type::Float ? "float" : "word";
}

// Offsets are in words of 32 bits. What shaders know and pages do not, such as an array of structs, is so many words.
Json fieldsJson(const std::vector<gpu::ReflectedMember>& members) {
  Json list = Json::array();
  for (const gpu::ReflectedMember& m : members)
    list.push_back({{"name", m.name},
                    {"offset", m.offset / 4},
                    {"components", m.bytes / 4},
                    {"type", typeName(m.type)}});
  return list;
}

Json portsJson(const graph::Plan& plan, size_t number, const graph::ElementTypes& types) {
  const BoundPass& pass = plan.graph->passes[number];
  const bool runs = plan.passLive[number] != 0;
  Json list = Json::array();
  for (const graph::Access& access : pass.accesses) {
    const graph::BoundResource& resource = plan.graph->resources[access.resource];
    const graph::PortSpec& port = pass.declaration->ports[access.port];
    const std::string& doc = port.members[access.member].doc;
    Json json{{"source", session::sourceName(pass, access)},
              {"name", session::portPath(pass, access)},
              {"direction", directionName(port.direction)},
              {"resource", resource.name},
              {"reads", access.reads},
              {"writes", access.writes},
              {"previous", access.previous},
              {"doc", doc.empty() ? port.doc : doc},
              {"is", graph::describe(resource.desc)},
              {"buffer", resource.desc.kind == graph::ResourceKind::Buffer},
              {"made", runs && plan.resourceLive[access.resource] != 0}};
    if (resource.desc.kind == graph::ResourceKind::Image) {
      json["mips"] = resource.desc.mips;
      json["layers"] = std::max(resource.desc.depth, resource.desc.layers);
    } else {
      json["count"] = resource.desc.count;
      const auto known = types.find(resource.desc.element);
      if (known != types.end()) json["fields"] = fieldsJson(known->second);
    }
    list.push_back(std::move(json));
  }
  return list;
}

std::vector<uint32_t> levelsOf(const graph::Plan& plan) {
  std::vector<uint32_t> levels(plan.graph->passes.size(), graph::kNone);
  for (uint32_t l = 0; l < plan.levels.size(); ++l)
    for (const uint32_t p : plan.levels[l].passes) levels[p] = l;
  return levels;
}

Json passesJson(const graph::Plan& plan, const graph::Description& description,
                const graph::Environment& environment, const Changes& changes,
                const graph::ElementTypes& types) {
  Json list = Json::array();
  const std::vector<uint32_t> levels = levelsOf(plan);
  for (size_t p = 0; p < plan.graph->passes.size(); ++p) {
    const BoundPass& pass = plan.graph->passes[p];
    Json json{{"name", pass.name},
              {"type", pass.declaration->type},
              {"doc", pass.declaration->doc},
              {"host", pass.declaration->kind == graph::PassKind::Host},
              {"view", plan.graph->views[pass.view]},
              {"level", levels[p] == graph::kNone ? Json(nullptr) : Json(levels[p])},
              {"parameters", parametersJson(plan, p, description, environment, changes)},
              {"ports", portsJson(plan, p, types)}};
    list.push_back(std::move(json));
  }
  return list;
}

// Which pass hands what to which other, by the versions of resources.
Json edgesJson(const graph::Plan& plan) {
  const graph::BoundGraph& graph = *plan.graph;
  struct Writer {
    uint32_t pass = graph::kNone;
    std::string source;
  };
  std::vector<std::vector<Writer>> writers(graph.resources.size());
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    for (const graph::Access& a : graph.passes[p].accesses) {
      if (!a.writes) continue;
      auto& of = writers[a.resource];
      if (of.size() <= a.version) of.resize(a.version + 1);
      of[a.version] = {p, session::sourceName(graph.passes[p], a)};
    }
  }
  Json list = Json::array();
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    for (const graph::Access& a : graph.passes[p].accesses) {
      const auto& by = writers[a.resource];
      if (!a.reads || by.empty() || (a.writes && a.version <= 1)) continue;
      const size_t version = a.previous ? by.size() - 1 : a.writes ? a.version - 1 : a.version;
      if (version >= by.size() || by[version].pass == graph::kNone || by[version].pass == p) continue;
      list.push_back({{"from", by[version].pass},
                      {"to", p},
                      {"source", by[version].source},
                      {"port", session::portPath(graph.passes[p], a)},
                      {"previous", a.previous}});
    }
  }
  return list;
}

Json viewJson(const graph::BoundGraph& bound, const Changes& changes) {
  Json list = Json::array();
  for (const ParameterSpec& spec : graph::viewParameters()) {
    Json json = specJson(spec);
    json["value"] = valueJson(*bound.view.find(spec.name));
    json["changed"] = changes.contains(std::string(graph::kViewPrefix) + spec.name);
    list.push_back(std::move(json));
  }
  return list;
}

// `prefix` is that of the names in `changes` and `settings`: "right." for those of a sub-graph. Only values with which the
// graph works are offered.
Json graphParametersJson(const std::vector<GraphParameter>& parameters, const std::string& prefix,
                         const std::vector<graph::Setting>& settings, const Changes& changes) {
  Json list = Json::array();
  for (const GraphParameter& p : parameters) {
    const auto setting = std::ranges::find(settings, prefix + p.name, &graph::Setting::name);
    Json json = setting != settings.end() ? specJson(setting->spec)
                : p.spec                  ? specJson(*p.spec)
                                          : Json{{"doc", ""}, {"type", "text"}};
    json["name"] = p.name;
    json["default"] = valueJson(*p.written);
    if (p.written->isString() && p.written->string.starts_with("$"))
      json["given_by"] = p.written->string.substr(1);
    const auto changed = changes.find(prefix + p.name);
    json["changed"] = changed != changes.end();
    json["value"] = changed != changes.end() ? Json(changed->second) : json["default"];
    list.push_back(std::move(json));
  }
  return list;
}

Json subGraphsJson(const graph::Plan& plan, const graph::Description& description, const Documents& documents,
                   const std::vector<graph::Setting>& settings, const Changes& changes) {
  Json list = Json::array();
  for (const auto& [name, document] : documents.subGraphs)
    list.push_back(
        {{"name", name},
         {"parameters", graphParametersJson(subGraphParameters(name, documents, description, *plan.graph),
                                            name + ".", settings, changes)}});
  return list;
}

// Where a message's file lies; shaders are named within the folders of data.
std::filesystem::path findMessageFile(const std::string& name) {
  std::error_code ec;
  if (std::filesystem::is_regular_file(name, ec)) return name;
  for (const char* kind : {"shaders", "passes", "graphs", "scenes"})
    for (const std::filesystem::path& folder : dataFolders(kind))
      for (const std::filesystem::path& at : {folder / name, folder.parent_path() / name})
        if (std::filesystem::is_regular_file(at, ec)) return at;
  return {};
}

std::string lineOf(const SourceLocation& where) {
  constexpr size_t kMost = 240;
  const std::filesystem::path file = where.line > 0 ? findMessageFile(where.file) : std::filesystem::path();
  if (file.empty()) return {};
  std::ifstream stream(file);
  std::string line;
  for (int i = 0; i < where.line; ++i)
    if (!std::getline(stream, line)) return {};
  return line.substr(0, kMost);
}

}  // namespace

nlohmann::json describeGraph(const graph::Plan& plan, const graph::Description& description,
                             const graph::Environment& environment, const Documents& documents,
                             const Changes& changes, const graph::ElementTypes& types) {
  const std::vector<graph::Setting> settings = graph::settings(description, environment);
  return {{"name", plan.graph->name},
          {"description", plan.graph->description},
          {"passes", passesJson(plan, description, environment, changes, types)},
          {"edges", edgesJson(plan)},
          {"outputs", describeOutputs(*plan.graph)},
          {"parameters",
           graphParametersJson(graphParameters(documents, description, *plan.graph), "", settings, changes)},
          {"view", viewJson(*plan.graph, changes)},
          {"sub_graphs", subGraphsJson(plan, description, documents, settings, changes)},
          {"levels", plan.levels.size()},
          {"plan", Json::parse(graph::planJson(plan))}};
}

nlohmann::json describeOutputs(const graph::BoundGraph& graph) {
  Json outputs = Json::array();
  for (const graph::BoundOutput& o : graph.outputs)
    outputs.push_back({{"name", o.name},
                       {"source", session::sourceOfOutput(graph, o)},
                       {"is", graph::describe(graph.resources[o.resource].desc)}});
  return outputs;
}

nlohmann::json describeTimes(const graph::FrameResult& frame) {
  Json passes = Json::array();
  for (const graph::PassTiming& pass : frame.passes) {
    Json steps = Json::array();
    for (const graph::StepTiming& step : pass.steps) steps.push_back({step.name, step.gpuMs});
    const graph::CommandCounts& c = pass.commands;
    passes.push_back({{"pass", pass.pass},
                      {"gpu", pass.gpuMs},
                      {"cpu", pass.cpuMs},
                      {"steps", steps},
                      {"commands",
                       {{"dispatches", c.dispatches},
                        {"indirect dispatches", c.indirectDispatches},
                        {"draws", c.draws},
                        {"renderings", c.renderings},
                        {"transfers", c.transfers},
                        {"barriers", c.barriers}}}});
  }
  Json counters = Json::array();
  for (const auto& [name, value] : frame.counters) counters.push_back({name, value});
  return {{"gpu", frame.gpuMs},         {"cpu", frame.cpuMs},         {"wall", frame.wallMs},
          {"animate", frame.animateMs}, {"observe", frame.observeMs}, {"passes", passes},
          {"counters", counters}};
}

std::string textOf(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json describeMessages(const std::vector<Diagnostic>& messages) {
  Json list = Json::array();
  for (const Diagnostic& d : messages) {
    list.push_back({{"severity", d.severity == Severity::Error     ? "error"
                                 : d.severity == Severity::Warning ? "warning"
                                                                   : "note"},
                    {"file", d.where.file},
                    {"line", d.where.line},
                    {"column", d.where.column},
                    {"path", d.path},
                    {"message", d.message},
                    {"remedy", d.remedy},
                    {"text", lineOf(d.where)}});
  }
  return list;
}

}  // namespace fovea::view
