// Part of bind(): tries the same graph with other values of its parameters.
#include "framework/graph/compile/fitting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fovea::graph {
namespace {

std::string rangeText(const ParameterSpec& spec) {
  const char* kind = spec.type == ParameterSpec::Type::Int ? "a whole number" : "a number";
  if (std::isinf(spec.min) && std::isinf(spec.max)) return kind;
  if (std::isinf(spec.max)) return fmt::format("{} of at least {}", kind, spec.min);
  if (std::isinf(spec.min)) return fmt::format("{} of at most {}", kind, spec.max);
  return fmt::format("{} from {} to {}", kind, spec.min, spec.max);
}

json::Value& keepText(Description& description, const json::Position& where, std::string key,
                      const std::string& text) {
  auto made = std::make_shared<json::Member>();
  made->key = std::move(key);
  made->keyWhere = made->value.where = where;
  made->value.type = json::Value::Type::String;
  made->value.string = text;
  description.made.push_back(made);
  return made->value;
}

bool isKnown(const Diagnostics& known, const Diagnostic& one) {
  return std::ranges::any_of(known.list(), [&](const Diagnostic& d) { return d.format() == one.format(); });
}

}  // namespace

std::string startOfType(const PassDescription& pass) {
  const json::Value* type = pass.written->value.find("type");
  return type ? type->string.substr(0, type->string.find('$')) : std::string();
}

Description withValue(const Description& description, uint32_t parameter, const std::string& text) {
  Description changed = description;
  GraphParameter& own = changed.graphParameters[parameter];
  const json::Value& value = keepText(
      changed, own.value.value ? own.value.value->where : own.declared->keyWhere, own.declared->key, text);
  const auto change = [&](ParameterDescription& given) {
    if (given.from != parameter) return;
    given.value = &value;
    given.fromCommandLine = true;
    given.fromEnvironment = false;
  };
  change(own.value);
  for (ParameterDescription& given : changed.parameters) change(given);
  for (ParameterDescription& given : changed.view) change(given);
  for (PassDescription& pass : changed.passes)
    if (pass.typeFrom == parameter) pass.type = &keepText(changed, value.where, {}, startOfType(pass) + text);
  return changed;
}

Description withValue(const Description& description, uint32_t pass, const std::string& name,
                      const std::string& text) {
  Description changed = description;
  keepText(changed, description.passes[pass].written->keyWhere, name, text);
  const std::shared_ptr<const json::Member> made = changed.made.back();
  PassDescription& own = changed.passes[pass];
  const ParameterDescription value{made.get(), &made->value, {}, true};
  const auto begin = changed.parameters.begin() + own.firstParameter, end = begin + own.parameterCount;
  const auto at = std::find_if(begin, end, [&](const auto& given) { return given.given->key == name; });
  if (at != end) {
    *at = value;
    return changed;
  }
  changed.parameters.insert(end, value);
  ++own.parameterCount;
  for (PassDescription& other : changed.passes)
    if (other.firstParameter >= own.firstParameter + own.parameterCount - 1 && &other != &own)
      ++other.firstParameter;
  return changed;
}

std::vector<std::string> typeEndings(const Description& description, const Registry& registry,
                                     uint32_t parameter) {
  std::vector<std::string> endings;
  for (const PassDescription& pass : description.passes) {
    if (pass.typeFrom != parameter) continue;
    const std::string start = startOfType(pass);
    for (const std::string& type : registry.types())
      if (type.starts_with(start) && std::ranges::count(endings, type.substr(start.size())) == 0)
        endings.push_back(type.substr(start.size()));
  }
  return endings;
}

std::vector<std::string> fittingValues(const Description& description, const Environment& environment,
                                       uint32_t parameter, const std::vector<std::string>& texts,
                                       const Diagnostics& known) {
  std::vector<std::string> fitting;
  for (const std::string& text : texts) {
    Diagnostics messages;
    try {
      bind(withValue(description, parameter, text), environment, messages, false);
    } catch (const Error&) {
    }
    const bool fits = std::ranges::all_of(messages.list(), [&](const Diagnostic& d) {
      return d.severity != Severity::Error || isKnown(known, d);
    });
    if (fits) fitting.push_back(text);
  }
  return fitting;
}

std::optional<ParameterSpec> commonSpec(const std::vector<const ParameterSpec*>& specs) {
  using Type = ParameterSpec::Type;
  const auto isNumber = [](Type type) { return type == Type::Int || type == Type::Real; };
  const auto isNoneOf = [](const ParameterSpec& spec) {
    return [&](const std::string& value) { return std::ranges::count(spec.choices, value) == 0; };
  };
  if (specs.empty()) return std::nullopt;
  const bool few = std::ranges::any_of(specs, [](const auto* spec) { return !spec->choices.empty(); });
  ParameterSpec common = *specs[0];
  for (const ParameterSpec* spec : specs) {
    if (isNumber(common.type) && isNumber(spec->type)) {
      if (spec->type == Type::Int) common.type = Type::Int;
      if (common.choices.empty())
        common.choices = spec->choices;
      else if (!spec->choices.empty())
        std::erase_if(common.choices, isNoneOf(*spec));
      common.min = std::max(common.min, spec->min);
      common.max = std::min(common.max, spec->max);
    } else if (spec->type == Type::Choice && (common.type == Type::Choice || common.type == Type::Text)) {
      if (common.type == Type::Text) common.choices = spec->choices;
      common.type = Type::Choice;
      std::erase_if(common.choices, isNoneOf(*spec));
    } else if (common.type != spec->type && !(common.type == Type::Choice && spec->type == Type::Text)) {
      return std::nullopt;
    }
  }
  if (common.min > common.max || (few && common.choices.empty())) return std::nullopt;
  return common;
}

std::string describeAllowed(const ParameterSpec& spec) {
  if (spec.choices.size() == 1) return fmt::format("only {}", spec.choices[0]);
  if (!spec.choices.empty()) return fmt::format("one of {}", fmt::join(spec.choices, ", "));
  switch (spec.type) {
    case ParameterSpec::Type::Bool:
      return "true or false";
    case ParameterSpec::Type::Int:
    case ParameterSpec::Type::Real:
      return rangeText(spec);
    case ParameterSpec::Type::Choice:
    case ParameterSpec::Type::Text:
      return "a text";
  }
  return {};
}

}  // namespace fovea::graph
