// Part of resolve(): the parameters of the graph and of sub-graphs, with what the command line sets, and where each
// value comes from.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "framework/base/number.h"
#include "framework/graph/resolve/expand.h"

namespace fovea::graph {
namespace detail {

using json::Member;
using Type = json::Value::Type;

namespace {

// The name of an instance in overrides: "left" for the prefix "left/".
std::string_view nameOf(const Scope& scope) {
  return std::string_view(scope.prefix).substr(0, scope.prefix.empty() ? 0 : scope.prefix.size() - 1);
}

GraphParameter* findIn(Expansion& all, const Scope& scope, std::string_view name) {
  for (const uint32_t p : scope.parameters)
    if (GraphParameter& parameter = all.description.graphParameters[p]; parameter.declared->key == name)
      return &parameter;
  return nullptr;
}

std::vector<std::string> namesIn(const Expansion& all, const Scope& scope, std::string_view before = {}) {
  std::vector<std::string> names;
  for (const uint32_t p : scope.parameters)
    names.push_back(std::string(before) + all.description.graphParameters[p].declared->key);
  return names;
}

// Whether a text stands for what the environment gives, to which the graph is bound later.
bool isOfEnvironment(std::string_view text) {
  return text.starts_with("$scene.") || text.starts_with("$device.");
}

// ---- Overrides ---------------------------------------------------------------------------------------

// Reads an override as the type of the value that it replaces. A text that cannot be read so stays one, and bind reports
// it with the values that the parameter allows.
ParameterDescription readOverride(Expansion& all, const Expansion::PendingOverride& o,
                                  const json::Value* current) {
  auto made = std::make_shared<Member>();
  json::Value& value = made->value;
  made->key = o.name;
  value.where.file = std::make_shared<const std::string>(o.source->typed());
  made->keyWhere = value.where;
  if (!current || current->isString() || !readTyped(o.source->value, current->type, value)) {
    value.type = Type::String;
    value.string = o.source->value;
  }
  all.description.made.push_back(made);
  return {made.get(), &value, {}, true};
}

// ---- Scopes ------------------------------------------------------------------------------------------

void declareParameters(Expansion& all, Scope& scope) {
  const json::Value* own = scope.document->find("parameters");
  if (!own || !own->isObject()) return;
  for (const Member& member : own->members) {
    if (!isName(member.key))
      report(all, scope, member.keyWhere, member.value,
             fmt::format("`{}` is no name for a parameter", member.key), "letters, digits, _ and -");
    const auto index = static_cast<uint32_t>(all.description.graphParameters.size());
    const std::string& text = member.value.string;
    GraphParameter parameter{&member, std::string(nameOf(scope)), "parameters." + member.key, {}};
    if (text.size() > 1 && text[0] == '$' && text[1] != '$' && !isOfEnvironment(text))
      report(all, scope, member.value, "a parameter's default cannot be another parameter",
             "write the value itself");
    else
      readScalar(all, scope, member.value, parameter.value);
    parameter.value.from = index;
    scope.parameters.push_back(index);
    all.description.graphParameters.push_back(std::move(parameter));
  }
}

const char* kindOf(const json::Value& value) {
  return value.isNumber() ? "a number" : value.isBool() ? "true or false" : "a text";
}

// Sets parameters of a sub-graph to what its parent gives.
void takeParameters(Expansion& all, Scope& scope, const json::Value& given) {
  Scope& parent = *scope.parent;
  for (const Member& member : given.members) {
    GraphParameter* parameter = findIn(all, scope, member.key);
    if (!parameter) {
      report(all, parent, member.keyWhere, member.value,
             fmt::format("the sub-graph has no parameter `{}`", member.key),
             nearestRemedy(member.key, namesIn(all, scope)));
      continue;
    }
    ParameterDescription read;
    if (!readScalar(all, parent, member.value, read) || !parameter->value.value) continue;
    const json::Value& wanted = *parameter->value.value;
    if (!read.fromCommandLine && std::string_view(kindOf(*read.value)) != kindOf(wanted)) {
      report(all, parent, member.value,
             fmt::format("expected {}, as the sub-graph's default, found {}", kindOf(wanted),
                         read.value->describe()));
      continue;
    }
    if (!read.from) {  // a literal
      read.from = parameter->value.from;
      parameter->path = fmt::format("passes.{}.parameters.{}", nameOf(scope), member.key);
    }
    parameter->value = read;
  }
}

}  // namespace

void readOverrides(Expansion& all) {
  for (const Override& o : all.options.overrides) {
    const size_t dot = o.name.rfind('.');
    if (dot == std::string::npos)
      all.overrides.push_back({"", o.name, &o});
    else
      all.overrides.push_back({o.name.substr(0, dot), o.name.substr(dot + 1), &o});
  }
}

void readParameters(Expansion& all, Scope& scope, const json::Value* given) {
  declareParameters(all, scope);
  if (given) takeParameters(all, scope, *given);
  for (Expansion::PendingOverride& o : all.overrides) {
    GraphParameter* parameter = o.target == nameOf(scope) ? findIn(all, scope, o.name) : nullptr;
    if (!parameter) continue;
    o.used = true;
    parameter->value = readOverride(all, o, parameter->value.value);
    parameter->value.from = static_cast<uint32_t>(parameter - all.description.graphParameters.data());
    parameter->path.clear();
  }
}

bool readScalar(Expansion& all, Scope& scope, const json::Value& value, ParameterDescription& out) {
  if (value.isNull() || value.isArray() || value.isObject()) {
    report(all, scope, value,
           fmt::format("expected true, false, a number or a text, found {}", value.describe()));
    return false;
  }
  out.value = &value;
  const std::string_view text = value.string;
  if (!value.isString() || text.size() < 2 || text[0] != '$') return true;
  if (text[1] == '$') {  // "$$" stands for one '$'
    Member plain{{}, value, {}};
    plain.value.string.erase(0, 1);
    out.value = &all.description.made.emplace_back(std::make_shared<Member>(std::move(plain)))->value;
    return true;
  }
  if (isOfEnvironment(text)) return out.fromEnvironment = true;
  GraphParameter* parameter = findIn(all, scope, text.substr(1));
  if (!parameter) {
    const std::string removed = fmt::format("parameters.{}", text.substr(1));
    if (!blameRemoval(all, scope, removed, value.where, pathOf(scope, value)))
      report(all, scope, value, fmt::format("no graph parameter `{}`", text),
             nearestRemedy(text, namesIn(all, scope, "$")));
    return false;
  }
  parameter->used = true;
  out.value = parameter->value.value;
  out.from = parameter->value.from;
  out.fromCommandLine = parameter->value.fromCommandLine;
  out.fromEnvironment = parameter->value.fromEnvironment;
  return out.value != nullptr;  // of a default with a mistake, which is reported
}

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

void reportUnusedParameters(Expansion& all) {
  for (const GraphParameter& p : all.description.graphParameters) {
    if (p.used || !p.value.value) continue;
    const json::Position& where = p.value.fromCommandLine ? p.value.value->where : p.declared->keyWhere;
    all.diagnostics.warning(where.location(), "parameters." + p.declared->key,
                            fmt::format("nothing uses the graph parameter `{}`", p.declared->key));
  }
  for (const Expansion::PendingOverride& o : all.overrides)
    if (!o.used) all.description.unusedOverrides.push_back(*o.source);
}

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

}  // namespace fovea::graph
