// Resolve: turns scopes, parameters, overrides and sub-graphs into one flat list of passes.
#include "framework/graph/compile/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "framework/base/number.h"
#include "framework/graph/compile/expand.h"

namespace fovea::graph {
namespace detail {

using json::Member;
using Type = json::Value::Type;

Scope::Parameter* Scope::findParameter(std::string_view name) {
  for (Parameter& p : parameters)
    if (p.declared->key == name) return &p;
  return nullptr;
}

Scope::Input* Scope::findInput(std::string_view name) {
  for (Input& i : inputs)
    if (i.declared->key == name) return &i;
  return nullptr;
}

namespace {

// Puts the place of `value` inside `document`, such as "passes.a.inputs.b", before `path`. False if it is not in it.
bool findPath(const json::Value& document, const json::Value& value, std::string& path) {
  if (&document == &value) return true;
  for (const Member& member : document.members) {
    if (!findPath(member.value, value, path)) continue;
    path = &member.value == &value ? member.key : member.key + "." + path;
    return true;
  }
  return false;
}

}  // namespace

void report(Expansion& all, const Scope& scope, const json::Position& where, const json::Value& value,
            std::string message, std::string remedy) {
  SourceLocation location = where.location();
  // A wire through a sub-graph's output is visited once for the output and once for each reader.
  for (const Diagnostic& d : all.diagnostics.list())
    if (d.where.line == location.line && d.where.column == location.column && d.message == message &&
        d.where.file == location.file)
      return;
  std::string path;
  findPath(*scope.document, value, path);
  all.diagnostics.error(std::move(location), std::move(path), std::move(message), std::move(remedy));
}

std::string nearestRemedy(std::string_view word, const std::vector<std::string>& names) {
  const std::string nearest = nearestName(word, names);
  if (!nearest.empty()) return fmt::format("did you mean `{}`?", nearest);
  if (names.empty() || names.size() > 40) return {};
  return fmt::format("there is: {}", fmt::join(names, ", "));
}

bool isName(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

// Whether a text stands for what the environment gives, to which the graph is bound later.
static bool isOfEnvironment(std::string_view text) {
  return text.starts_with("$scene.") || text.starts_with("$device.");
}

bool readScalar(Expansion& all, Scope& scope, const json::Value& value, ParameterDescription& out) {
  if (value.isNull() || value.isArray() || value.isObject()) {
    report(all, scope, value,
           fmt::format("expected true, false, a number or a text, found {}", value.describe()));
    return false;
  }
  out.value = &value;
  out.where = &value.where;
  const std::string_view text = value.string;
  if (!value.isString() || text.size() < 2 || text[0] != '$') return true;
  if (text[1] == '$') {  // "$$" stands for one '$'
    Member plain{{}, value, {}};
    plain.value.string.erase(0, 1);
    out.value = &all.description.made.emplace_back(std::make_shared<Member>(std::move(plain)))->value;
    return true;
  }
  if (isOfEnvironment(text)) return out.fromEnvironment = true;
  Scope::Parameter* parameter = scope.findParameter(text.substr(1));
  if (!parameter) {
    std::vector<std::string> names;
    for (const Scope::Parameter& p : scope.parameters) names.push_back("$" + p.declared->key);
    report(all, scope, value, fmt::format("no graph parameter `{}`", text), nearestRemedy(text, names));
    return false;
  }
  parameter->used = true;
  out.value = parameter->value.value;
  out.fromCommandLine = parameter->value.fromCommandLine;
  out.fromEnvironment = parameter->value.fromEnvironment;
  // A wrong value is reported where it was typed if it comes from the command line, otherwise where it is used.
  if (out.fromCommandLine) out.where = parameter->value.where;
  return true;
}

namespace {

// ---- Overrides ---------------------------------------------------------------------------------------

void readOverrides(Expansion& all) {
  for (const Override& o : all.options.overrides) {
    const size_t dot = o.name.rfind('.');
    if (dot == std::string::npos)
      all.overrides.push_back({"", o.name, &o});
    else
      all.overrides.push_back({o.name.substr(0, dot), o.name.substr(dot + 1), &o});
  }
}

std::string asTyped(const Override& o) { return fmt::format("--set {}={}", o.name, o.value); }

// Reads an override as the type of the value that it replaces; nullptr if that is not known yet.
ParameterDescription readOverride(Expansion& all, const Expansion::PendingOverride& o,
                                  const json::Value* current) {
  const std::string& text = o.source->value;
  auto made = std::make_shared<Member>();
  json::Value& value = made->value;
  made->key = o.name;
  value.where.file = std::make_shared<const std::string>(asTyped(*o.source));
  made->keyWhere = value.where;
  if (!current || current->isString()) {
    value.type = Type::String;
    value.string = text;
  } else if (!readTyped(text, current->type, value)) {
    // The value that it should have replaced stays, so that no second error follows.
    const json::Position where = value.where;
    value = *current;
    value.where = where;
    all.diagnostics.error(where.location(), {},
                          fmt::format("`{}` is {}, not `{}`", o.source->name,
                                      current->isBool() ? "true or false" : "a number", text));
  }
  all.description.made.push_back(made);
  return {made.get(), &value, &value.where, true};
}

// ---- Scopes ------------------------------------------------------------------------------------------

// The name of an instance in overrides: "left" for the prefix "left/".
std::string_view nameOf(const Scope& scope) {
  return std::string_view(scope.prefix).substr(0, scope.prefix.empty() ? 0 : scope.prefix.size() - 1);
}

void declareParameters(Expansion& all, Scope& scope) {
  const json::Value* own = scope.document->find("parameters");
  if (!own || !own->isObject()) return;
  for (const Member& member : own->members) {
    if (!isName(member.key))
      report(all, scope, member.keyWhere, member.value,
             fmt::format("`{}` is no name for a parameter", member.key), "letters, digits, _ and -");
    const std::string& text = member.value.string;
    Scope::Parameter parameter{&member, {}};
    if (text.size() > 1 && text[0] == '$' && text[1] != '$' && !isOfEnvironment(text))
      report(all, scope, member.value, "a parameter's default cannot be another parameter",
             "write the value itself");
    else if (readScalar(all, scope, member.value, parameter.value))
      scope.parameters.push_back(parameter);
  }
}

// Sets parameters of a sub-graph to what its parent gives.
void takeParameters(Expansion& all, Scope& scope, const json::Value& given) {
  Scope& parent = *scope.parent;
  for (const Member& member : given.members) {
    Scope::Parameter* parameter = scope.findParameter(member.key);
    if (!parameter) {
      std::vector<std::string> names;
      for (const Scope::Parameter& p : scope.parameters) names.push_back(p.declared->key);
      report(all, parent, member.keyWhere, member.value,
             fmt::format("the sub-graph has no parameter `{}`", member.key),
             nearestRemedy(member.key, names));
      continue;
    }
    ParameterDescription read;
    if (!readScalar(all, parent, member.value, read)) continue;
    const json::Value &value = *read.value, &wanted = *parameter->value.value;
    const bool fits = value.isNumber() || wanted.isNumber()
                          ? value.isNumber() == wanted.isNumber()
                          : value.type == wanted.type || read.fromCommandLine;
    if (fits)
      parameter->value = read;
    else
      report(all, parent, member.value,
             fmt::format("expected {}, as the sub-graph's default, found {}",
                         wanted.isNumber() ? "a number"
                         : wanted.isBool() ? "true or false"
                                           : "a text",
                         member.value.describe()));
  }
}

void readParameters(Expansion& all, Scope& scope, const json::Value* given) {
  declareParameters(all, scope);
  if (given) takeParameters(all, scope, *given);
  for (Expansion::PendingOverride& o : all.overrides) {
    Scope::Parameter* parameter = o.target == nameOf(scope) ? scope.findParameter(o.name) : nullptr;
    if (!parameter) continue;
    o.used = true;
    parameter->value = readOverride(all, o, parameter->value.value);
  }
}

std::optional<std::string_view> readView(Expansion& all, Scope& scope, const json::Value& value) {
  ParameterDescription name;
  if (!readScalar(all, scope, value, name)) return std::nullopt;
  if (name.value->isString()) return name.value->string;
  report(all, scope, value, fmt::format("expected the name of a view, found {}", value.describe()));
  return std::nullopt;
}

// A type may end in a graph parameter: "blur-$kernel". nullptr after a mistake.
const json::Value* readType(Expansion& all, Scope& scope, const json::Value& type) {
  const size_t dollar = type.string.find('$');
  if (dollar == std::string::npos) return &type;
  const auto keep = [&](std::string text) {
    auto made = std::make_shared<json::Member>();
    made->value = type;
    made->value.string = std::move(text);
    return &all.description.made.emplace_back(std::move(made))->value;
  };
  const json::Value& reference = *keep(type.string.substr(dollar));
  ParameterDescription ending;
  if (!readScalar(all, scope, reference, ending)) return nullptr;
  if (ending.value->isString()) return keep(type.string.substr(0, dollar) + ending.value->string);
  report(all, scope, type, fmt::format("`{}` is not a text, so it names no pass type", reference.string));
  return nullptr;
}

// Whether this is the file of the scope or of one around it, or whether scopes are nested too deeply.
bool containsItself(const Scope& scope, const std::filesystem::path& file) {
  int depth = 0;
  for (const Scope* at = &scope; at; at = at->parent)
    if (depth++ > kMaxInstanceDepth || at->file.lexically_normal() == file) return true;
  return false;
}

// The document of a sub-graph, with what it extends; nullptr after a mistake.
std::shared_ptr<const json::Value> instanceDocument(Expansion& all, const Scope& parent,
                                                    const json::Value& graph, std::filesystem::path& file) {
  if (!graph.isString()) {
    report(all, parent, graph, fmt::format("expected a file name, found {}", graph.describe()));
    return nullptr;
  }
  const std::filesystem::path from = graph.where.file ? *graph.where.file : parent.file.string();
  file = findGraphFile(graph.string, from, all.options.searchPaths).lexically_normal();
  if (file.empty()) {
    report(all, parent, graph, fmt::format("no graph file `{}`", graph.string),
           fmt::format("it is looked up beside {} and in the search paths", from.string()));
    return nullptr;
  }
  if (containsItself(parent, file)) {
    report(all, parent, graph, fmt::format("`{}` contains itself", graph.string));
    return nullptr;
  }
  try {
    auto document = std::make_shared<const json::Value>(detail::readGraphFile(file, all.diagnostics));
    return mergeExtends(std::move(document), file, all.options, all.diagnostics);
  } catch (const Error& e) {
    for (const Diagnostic& d : e.diagnostics()) all.diagnostics.add(d);
    return nullptr;
  }
}

void expandScope(Expansion& all, Scope& scope);

void expandInstance(Expansion& all, Scope& parent, const Member& member, const json::Value& graph,
                    json::ObjectReader& reader) {
  const json::Value* parameters = reader.object("parameters");
  const json::Value* inputs = reader.object("inputs");
  const json::Value* view = reader.find("view");
  std::filesystem::path file;
  const std::shared_ptr<const json::Value> document = instanceDocument(all, parent, graph, file);
  if (!document) return;
  ++all.made;
  Scope& scope = all.scopes.emplace_back();
  scope.file = file;
  scope.parent = &parent;
  scope.prefix = parent.prefix + member.key + "/";
  scope.view = view ? readView(all, parent, *view) : parent.view;
  scope.document = all.description.documents.emplace_back(document).get();
  parent.instances.emplace(member.key, &scope);
  readParameters(all, scope, parameters);
  readInputs(all, scope, inputs);
  for (const Scope::Input& input : scope.inputs)
    if (!input.wire && !input.optional)
      report(all, parent, member.keyWhere, member.value,
             fmt::format("input `{}` of the sub-graph `{}` is not wired", input.declared->key, member.key),
             fmt::format("add \"inputs\": {{\"{}\": \"pass.port\"}}", input.declared->key));
  expandScope(all, scope);
}

// ---- Passes ------------------------------------------------------------------------------------------

// Appends to `list` the values of an object, or those that overrides of `target` put in their place or beside them.
void readValues(Expansion& all, Scope& scope, std::vector<ParameterDescription>& list,
                const json::Value* values, std::string_view target) {
  const auto first = static_cast<ptrdiff_t>(list.size());
  if (values) {
    for (const Member& member : values->members) {
      ParameterDescription value{&member};
      if (readScalar(all, scope, member.value, value)) list.push_back(value);
    }
  }
  for (Expansion::PendingOverride& o : all.overrides) {
    if (o.target != target) continue;
    o.used = true;
    const ParameterDescription value = readOverride(all, o, nullptr);
    const auto at = std::find_if(list.begin() + first, list.end(),
                                 [&](const ParameterDescription& p) { return p.given->key == o.name; });
    if (at != list.end())
      *at = value;
    else
      list.push_back(value);
  }
}

void readPassParameters(Expansion& all, Scope& scope, PassDescription& pass, const json::Value* params) {
  std::vector<ParameterDescription>& list = all.description.parameters;
  pass.firstParameter = static_cast<uint32_t>(list.size());
  readValues(all, scope, list, params, pass.name);
  pass.parameterCount = static_cast<uint32_t>(list.size()) - pass.firstParameter;
}

void expandPass(Expansion& all, Scope& scope, const Member& member) {
  if (all.full) return;
  if (all.made > kMaxPasses) {
    all.full = true;
    return report(all, scope, member.keyWhere, member.value, fmt::format("more than {} passes", kMaxPasses));
  }
  if (!isName(member.key) || member.key == "inputs" || member.key == kViewTarget)
    return report(
        all, scope, member.keyWhere, member.value, fmt::format("`{}` is no name for a pass", member.key),
        "letters, digits, _ and -; `inputs` means the graph's own inputs, `view` what belongs to the "
        "frame");
  json::ObjectReader reader(member.value, "passes", member.key, all.diagnostics);
  if (!member.value.isObject()) return;
  reader.text("comment");
  const json::Value* graph = reader.find("graph");
  if (graph && !reader.has("type")) {
    expandInstance(all, scope, member, *graph, reader);
    return reader.finish();
  }
  if (graph) report(all, scope, graph->where, *graph, "a pass has a `type` or a `graph`, not both");
  ++all.made;
  const json::Value* type = reader.require("type");
  const auto index = static_cast<uint32_t>(all.description.passes.size());
  PassDescription& pass = all.description.passes.emplace_back();
  pass.name.append(scope.prefix).append(member.key);
  all.passes.emplace(pass.name, index);
  pass.written = &member;
  pass.view = scope.view;
  if (type && !type->isString())
    report(all, scope, *type, fmt::format("expected the name of a pass type, found {}", type->describe()));
  else if (type)
    pass.type = readType(all, scope, *type);
  if (const json::Value* view = reader.find("view")) {
    pass.view = readView(all, scope, *view);
    pass.ownView = view;
  }
  const json::Value* inputs = reader.object("inputs");
  all.origins.push_back({&scope, inputs});
  if (inputs)
    for (const Member& input : inputs->members)
      if (!input.value.isString())
        report(all, scope, input.value,
               fmt::format("expected a wire such as \"pass.port\", found {}", input.value.describe()));
  readPassParameters(all, scope, pass, reader.object("params"));
  reader.finish();
}

void expandScope(Expansion& all, Scope& scope) {
  json::ObjectReader reader(*scope.document, {}, all.diagnostics);
  reader.text("$schema");
  reader.find("extends");
  reader.find("version");  // read by migrateLoaded
  const std::string description = reader.text("description");
  if (!scope.parent) all.description.description = description;
  reader.object("parameters");  // read by readParameters
  reader.object("inputs");      // read by readRootInputs or readInputs
  const json::Value* view = reader.object("view");
  if (!scope.parent)
    readValues(all, scope, all.description.view, view, kViewTarget);
  else if (view)
    report(all, scope, *view, "a sub-graph cannot set what belongs to the frame",
           "set it in the graph that runs");
  reader.object("outputs");  // read with the wires
  if (const json::Value* passes = reader.object("passes")) {
    const size_t count = all.description.passes.size() + passes->members.size();
    all.description.passes.reserve(count);
    all.passes.reserve(count);
    for (const Member& member : passes->members) expandPass(all, scope, member);
  }
  reader.finish();
}

// ---- What nothing uses -------------------------------------------------------------------------------

void reportUnusedOverride(Expansion& all, const Expansion::PendingOverride& o) {
  std::vector<std::string> names, targets;
  for (const Scope& scope : all.scopes)
    for (const Scope::Parameter& p : scope.parameters)
      names.push_back(scope.prefix.empty() ? p.declared->key
                                           : fmt::format("{}.{}", nameOf(scope), p.declared->key));
  const auto& given = all.description.parameters;
  for (const PassDescription& pass : all.description.passes) {
    targets.push_back(pass.name);
    for (uint32_t i = 0; i < pass.parameterCount; ++i)
      if (given[pass.firstParameter + i].given->key == o.name) names = {pass.name + "." + o.name};
  }
  const std::string nearest = o.target.empty() ? std::string() : nearestName(o.target, targets);
  if (o.target.empty() && findParameter(viewParameters(), o.name))
    return all.diagnostics.error({asTyped(*o.source), 0, 0}, {},
                                 fmt::format("`{}` belongs to the frame, not to the graph", o.name),
                                 fmt::format("give --set view.{}={}", o.name, o.source->value));
  all.diagnostics.error({asTyped(*o.source), 0, 0}, {},
                        o.target.empty() ? fmt::format("the graph has no parameter `{}`", o.name)
                                         : fmt::format("the graph has no pass `{}`", o.target),
                        nearest.empty() ? nearestRemedy(o.source->name, names)
                                        : fmt::format("did you mean `{}.{}`?", nearest, o.name));
}

void reportUnused(Expansion& all) {
  for (const Scope& scope : all.scopes) {
    for (const Scope::Parameter& p : scope.parameters)
      if (!p.used) {
        const json::Position& where = p.value.fromCommandLine ? *p.value.where : p.declared->keyWhere;
        all.diagnostics.warning(where.location(), "parameters." + p.declared->key,
                                fmt::format("nothing uses the graph parameter `{}`", p.declared->key));
      }
    for (const Scope::Input& input : scope.inputs)
      if (!input.used)
        all.diagnostics.warning(input.declared->keyWhere.location(), "inputs." + input.declared->key,
                                fmt::format("nothing uses the input `{}`", input.declared->key));
  }
  for (const Expansion::PendingOverride& o : all.overrides)
    if (!o.used) reportUnusedOverride(all, o);
}

}  // namespace
}  // namespace detail

bool readTyped(const std::string& text, json::Value::Type type, json::Value& out) {
  using Type = json::Value::Type;
  if (type == Type::Bool) {
    out.boolean = text == "true" || text == "1";
    if (!out.boolean && text != "false" && text != "0") return false;
    out.type = Type::Bool;
    return true;
  }
  const std::optional<double> number = parseDecimal(text);
  if (!number) return false;
  out.setReal(*number);
  int64_t whole = 0;  // exact, also where doubles are not
  const char *begin = text.data(), *end = begin + text.size();
  if (const auto r = std::from_chars(begin, end, whole); r.ec == std::errc() && r.ptr == end) {
    out.type = Type::Int;
    out.integer = whole;
  }
  return true;
}

Description resolve(std::shared_ptr<const json::Value> document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics) {
  Description description;
  description.name = file.stem().string();
  description.documents.push_back(mergeExtends(std::move(document), file, options, diagnostics));
  detail::Expansion all{description, options, diagnostics};
  detail::readOverrides(all);
  ++all.made;
  detail::Scope& root = all.scopes.emplace_back();
  root.file = file;
  root.document = description.documents[0].get();
  description.start = {root.document->where.location().file, 1, 1};
  detail::readParameters(all, root, nullptr);
  detail::readRootInputs(all, root);
  detail::expandScope(all, root);
  if (all.full)
    diagnostics.throwIfErrors();  // rather than a mistake for each wire to a pass that was left out
  detail::resolveWires(all);
  detail::reportUnused(all);
  return description;
}

}  // namespace fovea::graph
