// Resolve, structure: turns scopes, parameters, overrides and sub-graphs into one flat list of passes.
#include "framework/graph/compile/expand.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fovea::graph::detail {

using json::Member;
using Type = json::Value::Type;

Scope::Input* Scope::findInput(std::string_view name) {
  for (Input& i : inputs)
    if (i.name == name) return &i;
  return nullptr;
}

Expander::Expander(Description& description, const LoadOptions& options, Diagnostics& diagnostics)
    : description_(description), options_(options), diagnostics_(diagnostics) {
  for (const Override& o : options.overrides) {
    const size_t dot = o.name.rfind('.');
    PendingOverride pending;
    pending.source = &o;
    if (dot != std::string::npos) pending.target = o.name.substr(0, dot);
    pending.name = dot == std::string::npos ? o.name : o.name.substr(dot + 1);
    overrides_.push_back(std::move(pending));
  }
}

void Expander::error(const json::Position& where, const Trail& path, std::string message,
                     std::string remedy) {
  // A wire through a sub-graph's output is visited once for the output and once for each reader.
  for (const Diagnostic& d : diagnostics_.list())
    if (d.where.line == where.line && d.where.column == where.column && d.message == message &&
        d.where.file == (where.file ? *where.file : std::string()))
      return;
  diagnostics_.error(where.location(), path.text(), std::move(message), std::move(remedy));
}

std::string Expander::nearestRemedy(std::string_view word, const std::vector<std::string>& names) {
  const std::string nearest = nearestName(word, names);
  if (!nearest.empty()) return fmt::format("did you mean `{}`?", nearest);
  if (names.empty() || names.size() > 40) return {};
  return fmt::format("there is: {}", fmt::join(names, ", "));
}

void Expander::enterFile(const std::shared_ptr<const std::string>& file) {
  latestFile_ = file.get();
  for (const auto& [known, index] : files_)
    if (known == file) {
      latestIndex_ = index;
      return;
    }
  const std::string name = file ? *file : std::string();
  std::vector<std::string>& names = description_.files;
  const auto at = std::find(names.begin(), names.end(), name);
  latestIndex_ = static_cast<uint32_t>(at - names.begin());
  if (at == names.end()) names.push_back(name);
  files_.emplace_back(file, latestIndex_);
}

// ---- Scopes ------------------------------------------------------------------------------------------

void Expander::expandRoot(const json::Value& document, const std::filesystem::path& file) {
  ++made_;
  Scope& root = scopes_.emplace_back(scratch_);
  root.file = file.native();
  root.document = &document;
  readParameters(root, nullptr, {});
  readRootInputs(root);
  expandScope(root);
}

constexpr std::string_view kGraphKeys[] = {"$schema", "extends", "description", "parameters",
                                           "inputs",  "outputs", "passes"};

void Expander::expandScope(Scope& scope) {
  json::ObjectReader reader(*scope.document, {}, diagnostics_);
  const auto [schema, extends, description, parameters, inputs, outputs, passes] =
      reader.findAll<kGraphKeys>();
  reader.expectText("$schema", schema);
  reader.expectText("description", description);
  if (description && !scope.parent) description_.description = description->string;
  reader.object("parameters", parameters);  // read by readParameters
  reader.object("inputs", inputs);          // read by readRootInputs or readInputs
  reader.object("outputs", outputs);        // read by wiring
  if (reader.object("passes", passes)) {
    const size_t count = description_.passes.size() + passes->members.size();
    description_.passes.reserve(count);
    description_.parameters.reserve(2 * count);
    description_.symbols.reserve(2 * count);
    rawFirst_.reserve(count + 1);
    rawWires_.reserve(2 * count);
    for (const Member& member : passes->members) expandPass(scope, member);
  }
  reader.finish();
}

void Expander::readParameters(Scope& scope, const json::Value* given, const Trail& givenPath) {
  if (const json::Value* own = scope.document->find("parameters"); own && own->isObject()) {
    scope.parameters.reserve(own->members.size());
    for (const Member& member : own->members) {
      const Trail parent("parameters"), path(parent, member.key);
      Scope::Parameter parameter;
      parameter.name = member.key;
      const json::Value& v = member.value;
      if (!isName(member.key))
        error(member.keyWhere, path, fmt::format("`{}` is no name for a parameter", member.key),
              "letters, digits, _ and -");
      if (v.isString() && v.string.size() > 1 && v.string[0] == '$' && v.string[1] != '$') {
        error(v.where, path, "a parameter's default cannot be another parameter", "write the value itself");
        continue;
      }
      if (readScalar(scope, v, path, parameter.value)) {
        parameter.value.keyPlace = place(member.keyWhere);
        scope.parameters.push_back(parameter);
      }
    }
  }
  if (given && given->isObject()) {
    for (const Member& member : given->members) {
      const Trail path(givenPath, member.key);
      Scope::Parameter* parameter = scope.findParameter(member.key);
      if (!parameter) {
        std::vector<std::string> names;
        for (const Scope::Parameter& p : scope.parameters) names.emplace_back(p.name);
        error(member.keyWhere, path, fmt::format("the sub-graph has no parameter `{}`", member.key),
              nearestRemedy(member.key, names));
        continue;
      }
      ParameterDescription value;
      if (!readScalar(*scope.parent, member.value, path, value)) continue;
      const bool number = value.type == Type::Int || value.type == Type::Real;
      const bool wanted = parameter->value.type == Type::Int || parameter->value.type == Type::Real;
      if (number != wanted || (!number && value.type != parameter->value.type && !value.fromCommandLine)) {
        error(member.value.where, path,
              fmt::format("expected {}, as the sub-graph's default, found {}",
                          wanted                                ? "a number"
                          : parameter->value.type == Type::Bool ? "true or false"
                                                                : "a text",
                          member.value.describe()));
        continue;
      }
      parameter->value = value;
    }
  }
  overrideParameters(scope);
}

void Expander::overrideParameters(Scope& scope) {
  const std::string target =
      scope.prefix.empty() ? std::string() : scope.prefix.substr(0, scope.prefix.size() - 1);
  for (PendingOverride& o : overrides_) {
    if (o.target != target) continue;
    Scope::Parameter* parameter = scope.findParameter(o.name);
    if (!parameter) continue;
    o.used = true;
    parameter->value = overrideValue(parameter->value, *o.source);
  }
}

// Reads the override as the type of the value that it replaces.
ParameterDescription Expander::overrideValue(const ParameterDescription& current, const Override& source) {
  json::Position where;
  where.file = std::make_shared<const std::string>(fmt::format("--set {}={}", source.name, source.value));
  ParameterDescription value;
  value.keyPlace = value.place = place(where);
  value.fromCommandLine = true;
  value.type = Type::String;
  value.text = intern(source.value);
  if (current.type == Type::String) return value;
  const std::string& text = source.value;
  const char* end = text.data() + text.size();
  if (current.type == Type::Bool) {
    value.type = Type::Bool;
    value.integer = text == "true" || text == "1";
    if (text != "true" && text != "false" && text != "0" && text != "1")
      error(where, {}, fmt::format("`{}` is true or false, not `{}`", source.name, text));
    return value;
  }
  if (const auto [at, ec] = std::from_chars(text.data(), end, value.integer);
      ec == std::errc() && at == end) {
    value.type = Type::Int;
    value.real = static_cast<double>(value.integer);
    return value;
  }
  value.type = Type::Real;
  const auto [at, ec] = std::from_chars(text.data(), end, value.real);
  if (ec != std::errc() || at != end || !std::isfinite(value.real)) {
    value.real = current.real;
    error(where, {}, fmt::format("`{}` is a number, not `{}`", source.name, text));
  }
  return value;
}

bool Expander::readScalar(Scope& scope, const json::Value& value, const Trail& path,
                          ParameterDescription& out) {
  out.type = value.type;
  out.place = place(value.where);
  switch (value.type) {
    case Type::Bool:
      out.integer = value.boolean;
      return true;
    case Type::Int:
      out.integer = value.integer;
      [[fallthrough]];
    case Type::Real:
      out.real = value.real;
      return true;
    case Type::String:
      break;
    default:
      return reportNoScalar(value, path), false;
  }
  const std::string& text = value.string;
  if (text.size() < 2 || text[0] != '$' || text[1] == '$') {  // "$$" stands for one '$'
    out.text = intern(text.size() >= 2 && text[0] == '$' ? std::string_view(text).substr(1)
                                                         : std::string_view(text));
    return true;
  }
  Scope::Parameter* parameter = scope.findParameter(std::string_view(text).substr(1));
  if (!parameter) return reportNoParameter(scope, value, path), false;
  parameter->used = true;
  const Place here = out.place;
  out = parameter->value;
  // A wrong value is reported where it was typed if it comes from the command line, otherwise where it is used.
  if (!out.fromCommandLine) out.place = here;
  return true;
}

void Expander::reportNoScalar(const json::Value& value, const Trail& path) {
  error(value.where, path,
        fmt::format("expected true, false, a number or a text, found {}", value.describe()));
}

void Expander::reportNoParameter(const Scope& scope, const json::Value& value, const Trail& path) {
  std::vector<std::string> names;
  for (const Scope::Parameter& p : scope.parameters) names.push_back(fmt::format("${}", p.name));
  error(value.where, path, fmt::format("no graph parameter `{}`", value.string),
        nearestRemedy(value.string, names));
}

Symbol Expander::readView(Scope& scope, const json::Value& value, const Trail& path) {
  ParameterDescription name;
  if (!readScalar(scope, value, path, name)) return kNone;
  if (name.type == Type::String) return name.text;
  error(value.where, path, fmt::format("expected the name of a view, found {}", value.describe()));
  return kNone;
}

// ---- Passes ------------------------------------------------------------------------------------------

constexpr std::string_view kPassKeys[] = {"comment", "graph", "type", "view", "inputs", "params"};

void Expander::expandPass(Scope& scope, const Member& member) {
  if (full_) return;
  const Trail passes("passes"), path(passes, member.key);
  if (made_ > kMaxPasses) {
    full_ = true;
    return error(member.keyWhere, path, fmt::format("more than {} passes", kMaxPasses));
  }
  if (!isName(member.key) || sameText(member.key, "inputs"))
    return error(member.keyWhere, path, fmt::format("`{}` is no name for a pass", member.key),
                 "letters, digits, _ and -; `inputs` means the graph's own inputs");
  json::ObjectReader reader(member.value, "passes", member.key, diagnostics_);
  if (!member.value.isObject()) return;
  const auto [comment, graph, type, view, inputs, params] = reader.findAll<kPassKeys>();
  if (graph && !type) {
    json::ObjectReader instance(member.value, "passes", member.key, diagnostics_);
    instance.text("comment");
    instance.find("graph");
    expandInstance(scope, member, *graph, instance);
    return instance.finish();
  }
  reader.expectText("comment", comment);
  if (graph) error(graph->where, {path, "graph"}, "a pass has a `type` or a `graph`, not both");
  if (!type) reader.reportMissing("type");
  PassDescription& pass = addPass(scope, member, path, type);
  if (view) {
    pass.view = readView(scope, *view, {path, "view"});
    pass.viewPlace = place(view->where);
    pass.ownView = true;
  }
  if (reader.object("inputs", inputs)) addPassInputs(scope, member, inputs->members, path);
  addPassParameters(scope, pass, reader.object("params", params), {path, "params"});
  reader.finish();
}

PassDescription& Expander::addPass(Scope& scope, const Member& member, const Trail& path,
                                   const json::Value* type) {
  ++made_;
  PassDescription& pass = description_.passes.emplace_back();
  pass.name = scope.prefix.empty() ? intern(member.key) : intern(scope.prefix + member.key);
  pass.place = pass.typePlace = pass.viewPlace = place(member.keyWhere);
  pass.view = scope.view;
  rawFirst_.push_back(static_cast<uint32_t>(rawWires_.size()));
  if (!type) return pass;
  pass.typePlace = place(type->where);
  if (type->isString())
    pass.type = readType(scope, *type, {path, "type"});
  else
    error(type->where, {path, "type"},
          fmt::format("expected the name of a pass type, found {}", type->describe()));
  return pass;
}

// A type may end in a graph parameter: "vpl-intensity-$intensity".
Symbol Expander::readType(Scope& scope, const json::Value& type, const Trail& path) {
  const size_t dollar = type.string.find('$');
  if (dollar == std::string::npos) return intern(type.string);
  json::Value reference = type;
  reference.string.erase(0, dollar);
  ParameterDescription ending;
  if (!readScalar(scope, reference, path, ending)) return kNone;
  if (ending.type == Type::String)
    return intern(type.string.substr(0, dollar) + std::string(description_.symbols[ending.text]));
  error(type.where, path, fmt::format("`{}` is not a text, so it names no pass type", reference.string));
  return kNone;
}

void Expander::addPassInputs(Scope& scope, const Member& pass, const std::vector<Member>& inputs,
                             const Trail& path) {
  const Trail inputsPath(path, "inputs");
  for (const Member& input : inputs) {
    if (input.value.isString())
      rawWires_.push_back({&scope, pass.key, keep(input.key), &input.value, place(input.keyWhere)});
    else
      error(input.value.where, {inputsPath, input.key},
            fmt::format("expected a wire such as \"pass.port\", found {}", input.value.describe()));
  }
}

void Expander::addPassParameters(Scope& scope, PassDescription& pass, const json::Value* params,
                                 const Trail& path) {
  pass.firstParameter = static_cast<uint32_t>(description_.parameters.size());
  if (params) {
    for (const Member& param : params->members) {
      ParameterDescription& value = description_.parameters.emplace_back();
      if (!readScalar(scope, param.value, {path, param.key}, value)) {
        description_.parameters.pop_back();
        continue;
      }
      value.name = keep(param.key);
      value.keyPlace = place(param.keyWhere);
    }
  }
  if (!overrides_.empty()) overridePass(pass);
  pass.parameterCount = static_cast<uint32_t>(description_.parameters.size()) - pass.firstParameter;
}

void Expander::overridePass(PassDescription& pass) {
  for (PendingOverride& o : overrides_) {
    if (o.target.empty() || o.target != description_.symbols[pass.name]) continue;
    o.used = true;
    ParameterDescription as;
    as.type = Type::String;
    ParameterDescription value = overrideValue(as, *o.source);
    value.name = keep(o.name);
    auto& all = description_.parameters;
    const auto at = std::find_if(all.begin() + pass.firstParameter, all.end(),
                                 [&](const ParameterDescription& p) { return p.name == value.name; });
    if (at != all.end())
      *at = value;
    else
      all.push_back(value);
  }
}

void Expander::expandInstance(Scope& parent, const Member& member, const json::Value& graph,
                              json::ObjectReader& reader) {
  const std::string path = json::joinPath("passes", member.key);
  const json::Value* parameters = reader.object("parameters");
  const json::Value* inputs = reader.object("inputs");
  const json::Value* view = reader.find("view");
  if (!graph.isString())
    return error(graph.where, json::joinPath(path, "graph"),
                 fmt::format("expected a file name, found {}", graph.describe()));
  const std::filesystem::path from = graph.where.file ? *graph.where.file : parent.file;
  const std::filesystem::path file =
      findGraphFile(graph.string, from, options_.searchPaths).lexically_normal();
  if (file.empty())
    return error(graph.where, json::joinPath(path, "graph"), fmt::format("no graph file `{}`", graph.string),
                 fmt::format("it is looked up beside {} and in the search paths", from.string()));
  if (containsItself(parent, file))
    return error(graph.where, json::joinPath(path, "graph"),
                 fmt::format("`{}` contains itself", graph.string));
  json::Value& parsed = documents_.emplace_back();
  try {
    parsed = json::parseFile(file);
  } catch (const Error& e) {
    for (const Diagnostic& d : e.diagnostics()) diagnostics_.add(d);
    return;
  }
  ++made_;
  Scope& scope = scopes_.emplace_back(scratch_);
  scope.file = file.native();
  scope.parent = &parent;
  scope.path = path;
  scope.prefix = parent.prefix + member.key + "/";
  scope.view = view ? readView(parent, *view, json::joinPath(path, "view")) : parent.view;
  scope.document = &mergeExtends(parsed, file, options_, diagnostics_, documents_.emplace_back());
  parent.instances.emplace(member.key, &scope);
  readParameters(scope, parameters, json::joinPath(path, "parameters"));
  readInputs(scope, inputs);
  for (const Scope::Input& input : scope.inputs)
    if (!input.wire && !input.optional)
      error(member.keyWhere, path,
            fmt::format("input `{}` of the sub-graph `{}` is not wired", input.name, member.key),
            fmt::format("add \"inputs\": {{\"{}\": \"pass.port\"}}", input.name));
  expandScope(scope);
}

// Whether this is the file of the scope or of one around it, or whether scopes are nested too deeply.
bool Expander::containsItself(const Scope& scope, const std::filesystem::path& file) {
  int depth = 0;
  for (const Scope* at = &scope; at; at = at->parent)
    if (depth++ > kMaxInstanceDepth || std::filesystem::path(at->file).lexically_normal() == file)
      return true;
  return false;
}

void Expander::reportUnused() {
  for (const Scope& scope : scopes_) {
    for (const Scope::Parameter& p : scope.parameters) {
      if (!p.used)
        diagnostics_.warning(description_.location(p.value.keyPlace), fmt::format("parameters.{}", p.name),
                             fmt::format("nothing uses the graph parameter `{}`", p.name));
    }
    for (const Scope::Input& input : scope.inputs)
      if (!input.used)
        diagnostics_.warning(description_.location(input.place), "inputs." + input.name,
                             fmt::format("nothing uses the input `{}`", input.name));
  }
  for (const PendingOverride& o : overrides_) {
    if (o.used) continue;
    std::vector<std::string> names, targets;
    for (const Scope& scope : scopes_)
      for (const Scope::Parameter& p : scope.parameters)
        names.push_back(scope.prefix.empty()
                            ? std::string(p.name)
                            : fmt::format("{}.{}", scope.prefix.substr(0, scope.prefix.size() - 1), p.name));
    for (const PassDescription& pass : description_.passes)
      targets.emplace_back(description_.symbols[pass.name]);
    const SourceLocation where{fmt::format("--set {}={}", o.source->name, o.source->value), 0, 0};
    const std::string nearest = nearestName(o.target, targets);
    const bool pass = !o.target.empty() && !nearest.empty();
    diagnostics_.error(
        where, {},
        o.target.empty() ? fmt::format("the graph has no parameter `{}`", o.name)
                         : fmt::format("the graph has no pass `{}`", o.target),
        pass ? fmt::format("did you mean `{}.{}`?", nearest, o.name) : nearestRemedy(o.source->name, names));
  }
}

}  // namespace fovea::graph::detail
