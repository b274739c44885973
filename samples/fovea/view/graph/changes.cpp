#include "samples/fovea/view/graph/changes.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/migrate/migrate.h"

namespace fovea::view {
namespace {

using graph::ParameterSpec;
using json::Value;

// The parameter to which a value such as "$radius" refers.
std::string_view referred(const Value& value) {
  return value.isString() && value.string.starts_with("$") ? std::string_view(value.string).substr(1)
                                                           : std::string_view();
}

const graph::BoundPass* findPass(const graph::BoundGraph& bound, std::string_view name) {
  for (const graph::BoundPass& pass : bound.passes)
    if (pass.name == name) return &pass;
  return nullptr;
}

const ParameterSpec* findSpec(const graph::BoundPass& pass, std::string_view name) {
  for (const ParameterSpec& spec : pass.declaration->parameters)
    if (spec.name == name) return &spec;
  return nullptr;
}

// Inside an instance of a sub-graph, the parameter that the instance is given as `inner`.
const ParameterSpec* specInside(const std::string& instance, std::string_view inner,
                                const graph::Description& description, const graph::BoundGraph& bound) {
  for (const graph::PassDescription& pass : description.passes) {
    if (!pass.name.starts_with(instance + "/")) continue;
    for (uint32_t i = 0; i < pass.parameterCount; ++i) {
      const graph::ParameterDescription& p = description.parameters[pass.firstParameter + i];
      if (!p.given || referred(p.given->value) != inner) continue;
      if (const graph::BoundPass* found = findPass(bound, pass.name)) return findSpec(*found, p.given->key);
    }
  }
  return nullptr;
}

// `prefix` is that of the passes of a sub-graph, "left/".
const ParameterSpec* specOf(const std::string& name, const Value& passes, const std::string& prefix,
                            const graph::Description& description, const graph::BoundGraph& bound) {
  for (const json::Member& pass : passes.members) {
    const Value* params = pass.value.find("params");
    for (const json::Member& given : params ? params->members : std::vector<json::Member>()) {
      if (referred(given.value) != name) continue;
      const graph::BoundPass* found = findPass(bound, prefix + pass.key);
      const ParameterSpec* spec =
          found ? findSpec(*found, given.key) : specInside(prefix + pass.key, given.key, description, bound);
      if (spec) return spec;
    }
  }
  return nullptr;
}

Value textValue(std::string text) {
  Value value;
  value.type = Value::Type::String;
  value.string = std::move(text);
  return value;
}

Value wholeValue(int64_t number) {
  Value value;
  value.type = Value::Type::Int;
  value.integer = number;
  return value;
}

Value objectValue() {
  Value value;
  value.type = Value::Type::Object;
  return value;
}

Value& childOf(Value& object, const std::string& key) {
  for (json::Member& member : object.members)
    if (member.key == key) return member.value;
  return object.members.emplace_back(json::Member{key, objectValue(), {}}).value;
}

// The value that a text means for a parameter of this type.
Value typed(const std::string& name, const std::string& text, Value::Type type) {
  if (type == Value::Type::String) return textValue(text);
  Value value;
  if (graph::readTyped(text, type, value)) return value;
  throw Error(ExitCode::BadInput, fmt::format("`{}` cannot be `{}`", name, text));
}

Value::Type typeOf(const ParameterSpec& spec) {
  switch (spec.type) {
    case ParameterSpec::Type::Bool:
      return Value::Type::Bool;
    case ParameterSpec::Type::Int:
      return Value::Type::Int;
    case ParameterSpec::Type::Real:
      return Value::Type::Real;
    default:
      return Value::Type::String;
  }
}

}  // namespace

std::vector<std::string> overridesOf(const Changes& changes) {
  std::vector<std::string> list;
  for (const auto& [name, value] : changes) list.push_back(fmt::format("{}={}", name, value));
  return list;
}

Changes changesOf(const std::vector<std::string>& overrides) {
  Changes changes;
  for (const std::string& text : overrides) {
    graph::Override parsed = graph::parseOverride(text);
    changes[std::move(parsed.name)] = std::move(parsed.value);
  }
  return changes;
}

Documents loadDocuments(const std::filesystem::path& graph, const graph::LoadOptions& options) {
  Documents documents{graph::loadMerged(graph, options), {}};
  const Value* passes = documents.graph.find("passes");
  for (const json::Member& pass : passes ? passes->members : std::vector<json::Member>()) {
    const Value* file = pass.value.find("graph");
    if (!file || !file->isString()) continue;
    const std::filesystem::path from = file->where.file ? *file->where.file : graph.string();
    const std::filesystem::path found = graph::findGraphFile(file->string, from, options.searchPaths);
    documents.subGraphs.emplace(pass.key, graph::loadMerged(found, options));
  }
  return documents;
}

namespace {

std::vector<GraphParameter> parametersOf(const Value& document, const std::string& prefix,
                                         const graph::Description& description,
                                         const graph::BoundGraph& bound) {
  std::vector<GraphParameter> list;
  const Value* parameters = document.find("parameters");
  const Value* passes = document.find("passes");
  if (!parameters || !passes) return list;
  for (const json::Member& member : parameters->members)
    list.push_back({member.key, &member.value, specOf(member.key, *passes, prefix, description, bound)});
  return list;
}

}  // namespace

std::vector<GraphParameter> graphParameters(const Documents& documents, const graph::Description& description,
                                            const graph::BoundGraph& bound) {
  return parametersOf(documents.graph, "", description, bound);
}

std::vector<GraphParameter> subGraphParameters(const std::string& instance, const Documents& documents,
                                               const graph::Description& description,
                                               const graph::BoundGraph& bound) {
  std::vector<GraphParameter> list =
      parametersOf(documents.subGraphs.at(instance), instance + "/", description, bound);
  const Value* given = documents.graph.find("passes")->find(instance)->find("parameters");
  for (GraphParameter& parameter : list)
    if (const Value* own = given ? given->find(parameter.name) : nullptr) parameter.written = own;
  return list;
}

namespace {

// The value of a parameter of a graph with these parameters.
Value valueFor(const std::string& name, const std::string& text, const Value* declared) {
  const Value::Type type = declared ? declared->type : Value::Type::String;
  return typed(name, text, type == Value::Type::Int ? Value::Type::Real : type);
}

// A parameter of a pass or of a sub-graph, "deferred.kernel", in the graph that is to be written.
void addInner(Value& graph, const std::string& name, const std::string& text, const Documents& documents,
              const graph::BoundGraph& bound) {
  const size_t dot = name.rfind('.');
  const std::string pass = name.substr(0, dot), key = name.substr(dot + 1);
  if (pass.find('/') != std::string::npos)
    throw Error(
        ExitCode::BadInput,
        fmt::format("`{}` lies inside of a sub-graph, which a graph that extends this one cannot reach",
                    name),
        "take it back, or make it a parameter of the sub-graph");
  const auto subGraph = documents.subGraphs.find(pass);
  const Value* parameters =
      subGraph != documents.subGraphs.end() ? subGraph->second.find("parameters") : nullptr;
  const Value* declared = parameters ? parameters->find(key) : nullptr;
  const graph::BoundPass* found = findPass(bound, pass);
  const ParameterSpec* spec = found ? findSpec(*found, key) : nullptr;
  if (!spec && !declared)
    throw Error(ExitCode::BadInput, fmt::format("the graph has no parameter `{}`", name));
  Value& changed = childOf(childOf(graph, "passes"), pass);
  childOf(childOf(changed, declared ? "parameters" : "params"), key) =
      declared ? valueFor(name, text, declared) : typed(name, text, typeOf(*spec));
}

}  // namespace

std::string extendingGraph(const std::string& base, const Changes& changes, const Documents& documents,
                           const graph::BoundGraph& bound) {
  Value graph = objectValue();
  childOf(graph, "$schema") = textValue("fovea-graph.schema.json");
  childOf(graph, "version") = wholeValue(graph::kGraphVersion);
  childOf(graph, "extends") = textValue(base);
  const Value* parameters = documents.graph.find("parameters");
  for (const auto& [name, text] : changes) {
    if (name.find('.') == std::string::npos)
      childOf(childOf(graph, "parameters"), name) =
          valueFor(name, text, parameters ? parameters->find(name) : nullptr);
    else if (const ParameterSpec* ofView = graph::findParameter({}, name))
      childOf(childOf(graph, "view"), ofView->name) = typed(name, text, typeOf(*ofView));
    else
      addInner(graph, name, text, documents, bound);
  }
  return json::print(graph);
}

}  // namespace fovea::view
