// Resolve: turns scopes, parameters, overrides and sub-graphs into one flat list of passes.
#include "framework/graph/resolve/resolve.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/resolve/expand.h"

namespace fovea::graph {
namespace detail {

using json::Member;
using Type = json::Value::Type;

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
  all.diagnostics.error(where.location(), pathOf(scope, value), std::move(message), std::move(remedy));
}

std::string pathOf(const Scope& scope, const json::Value& value) {
  std::string path;
  findPath(*scope.document, value, path);
  return path;
}

std::string nearestRemedy(std::string_view word, const std::vector<std::string>& names) {
  const std::string nearest = nearestName(word, names);
  if (!nearest.empty()) return fmt::format("did you mean `{}`?", nearest);
  if (names.empty() || names.size() > 40) return {};
  return fmt::format("there is: {}", fmt::join(names, ", "));
}

bool blameRemoval(Expansion& all, const Scope& scope, const std::string& path, const json::Position& by,
                  std::string who) {
  Removal* removal = findRemoval(all.description.removals, scope.document, path);
  if (!removal || layerOf(all.description, removal->where) >= layerOf(all.description, by)) return false;
  removal->neededAt.push_back(std::move(who));
  return true;
}

bool isName(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

namespace {

// ---- Scopes ------------------------------------------------------------------------------------------

std::optional<std::string_view> readView(Expansion& all, Scope& scope, const json::Value& value) {
  ParameterDescription name;
  if (!readScalar(all, scope, value, name)) return std::nullopt;
  if (name.value->isString()) return name.value->string;
  report(all, scope, value, fmt::format("expected the name of a view, found {}", value.describe()));
  return std::nullopt;
}

// A type may end in a graph parameter: "blur-$kernel". nullptr after a mistake.
const json::Value* readType(Expansion& all, Scope& scope, const json::Value& type,
                            std::optional<uint32_t>& from) {
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
  from = ending.from;
  // A value that is not a text gives the name of a type that does not exist. bind() reports it and lists those that do.
  std::string text = ending.value->isString() ? ending.value->string : json::print(*ending.value);
  if (text.ends_with('\n')) text.pop_back();
  return keep(type.string.substr(0, dollar) + text);
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
           graphFileRemedy(graph.string, from, all.options.searchPaths));
    return nullptr;
  }
  if (containsItself(parent, file)) {
    report(all, parent, graph, fmt::format("`{}` contains itself", graph.string));
    return nullptr;
  }
  Diagnostics own;
  try {
    auto document = std::make_shared<const json::Value>(detail::readGraphFile(file, own));
    Merged merged = mergeExtends(std::move(document), file, all.options, own);
    for (const Diagnostic& d : own.list())  // errors as well: a `null` that removes nothing, for instance
      d.severity == Severity::Error ? all.diagnostics.error(d.where, d.path, d.message, d.remedy)
                                    : all.diagnostics.warning(d.where, d.path, d.message, d.remedy);
    return all.description.take(std::move(merged));
  } catch (const Error& e) {
    for (const Diagnostic& d : e.diagnostics()) all.diagnostics.error(d.where, d.path, d.message, d.remedy);
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
  if (!document) return parent.broken.push_back(member.key);
  ++all.made;
  Scope& scope = all.scopes.emplace_back();
  scope.file = file;
  scope.parent = &parent;
  scope.prefix = parent.prefix + member.key + "/";
  scope.view = view ? readView(all, parent, *view) : parent.view;
  scope.document = document.get();
  all.description.instances.push_back(scope.prefix.substr(0, scope.prefix.size() - 1));
  parent.instances.emplace(member.key, &scope);
  readParameters(all, scope, parameters);
  readInputs(all, scope, inputs);
  for (const Scope::Input& input : scope.inputs) {
    if (input.wire || input.optional) continue;
    const std::string path = fmt::format("passes.{}.inputs.{}", member.key, input.declared->key);
    if (blameRemoval(all, parent, path, graph.where,
                     fmt::format("inputs.{} of {}", input.declared->key, file.string())))
      continue;
    report(all, parent, member.keyWhere, member.value,
           fmt::format("input `{}` of the sub-graph `{}` is not wired", input.declared->key, member.key),
           fmt::format("add \"inputs\": {{\"{}\": \"pass.port\"}}", input.declared->key));
  }
  expandScope(all, scope);
}

// ---- Passes ------------------------------------------------------------------------------------------

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
  const bool isGood = isName(member.key) && member.key != "inputs" && member.key != kViewTarget;
  if (!isGood || !member.value.isObject()) scope.broken.push_back(member.key);
  if (!isGood)
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
  if (graph) {
    scope.broken.push_back(member.key);
    return report(all, scope, graph->where, *graph, "a pass has a `type` or a `graph`, not both");
  }
  ++all.made;
  const json::Value* type = reader.require("type");
  const auto index = static_cast<uint32_t>(all.description.passes.size());
  PassDescription& pass = all.description.passes.emplace_back();
  pass.name.append(scope.prefix).append(member.key);
  all.passes.emplace(pass.name, index);
  pass.written = &member;
  pass.document = scope.document;
  pass.view = scope.view;
  if (type && !type->isString())
    report(all, scope, *type, fmt::format("expected the name of a pass type, found {}", type->describe()));
  else if (type)
    pass.type = readType(all, scope, *type, pass.typeFrom);
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

// Warns about what the graph and its sub-graphs declare and no document uses.
void reportUnused(Expansion& all) {
  for (const Scope& scope : all.scopes)
    for (const Scope::Input& input : scope.inputs)
      if (!input.used)
        all.diagnostics.warning(input.declared->keyWhere.location(), "inputs." + input.declared->key,
                                fmt::format("nothing uses the input `{}`", input.declared->key));
  reportUnusedParameters(all);
}

}  // namespace
}  // namespace detail

std::shared_ptr<const json::Value> Description::take(Merged merged) {
  files.insert(files.end(), merged.files.begin(), merged.files.end());
  removals.insert(removals.end(), merged.removals.begin(), merged.removals.end());
  return documents.emplace_back(std::move(merged.document));
}

Description resolve(std::shared_ptr<const json::Value> document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics) {
  Description description;
  description.name = file.stem().string();
  detail::Expansion all{description, options, diagnostics};
  detail::readOverrides(all);
  ++all.made;
  detail::Scope& root = all.scopes.emplace_back();
  root.file = file;
  root.document = description.take(mergeExtends(std::move(document), file, options, diagnostics)).get();
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
