// Part of bind(): evaluates the parameters of passes and of the view, and finds values that are not allowed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/graph/compile/binding.h"

namespace fovea::graph::detail {
namespace {

// False if the value is of another type or out of range.
bool assign(const ParameterSpec& spec, const json::Value& given, Value& out) {
  using Type = ParameterSpec::Type;
  const bool inRange = given.real >= spec.min && given.real <= spec.max && std::isfinite(given.real);
  switch (spec.type) {
    case Type::Bool:
      if (given.isBool()) out = given.boolean;
      return given.isBool();
    case Type::Int:
      if (!given.isInt() || !inRange) return false;
      if (!spec.choices.empty() && std::ranges::count(spec.choices, std::to_string(given.integer)) == 0)
        return false;
      out = given.integer;
      return true;
    case Type::Real:
      if (!given.isNumber() || !inRange) return false;
      out = given.real;
      return true;
    case Type::Choice:
      if (std::find(spec.choices.begin(), spec.choices.end(), given.string) == spec.choices.end())
        return false;
      break;
    case Type::Text:
      break;
  }
  if (given.isString()) out = given.string;
  return given.isString();
}

std::string describeGiven(const json::Value& given) {
  if (given.isBool()) return given.boolean ? "true" : "false";
  if (given.isInt()) return fmt::format("{}", given.integer);
  return given.isNumber() ? fmt::format("{}", given.real) : fmt::format("`{}`", given.string);
}

// path: of the value in its document.
void readParameter(Binding& b, std::string path, const ParameterSpec& spec, const ParameterDescription& given,
                   Value& out) {
  if (given.from) b.uses[*given.from].push_back(&spec);
  json::Value value = *given.value;
  if (given.fromEnvironment) value.string = fromEnvironment(b, value.string);
  if (assign(spec, value, out)) return;
  using Type = ParameterSpec::Type;
  if (given.fromCommandLine && value.isString() && spec.type != Type::Choice && spec.type != Type::Text) {
    using Json = json::Value::Type;
    if (readTyped(value.string, spec.type == Type::Bool ? Json::Bool : Json::Real, value) &&
        assign(spec, value, out))
      return;
  }
  b.wrongValues.push_back({&given, &spec, std::move(path), describeGiven(value), value.string});
}

void reportWrong(Binding& b, const json::Position& where, std::string path, const std::string& name,
                 const ParameterSpec& allowed, const WrongValue& wrong) {
  const std::string nearest = nearestName(wrong.text, allowed.choices);
  report(b, where, std::move(path),
         fmt::format("parameter `{}`: expected {}, found {}", name, describeAllowed(allowed), wrong.found),
         nearest.empty() ? nearest : fmt::format("did you mean `{}`?", nearest));
}

// Whether to blame the place that takes a value rather than the graph parameter that gives it: either this place is
// nearer to the user, or it cannot take a value of this kind while other places can.
bool isWrongUse(const Binding& b, const WrongValue& wrong, size_t wrongUses) {
  const int use = layerOf(b.description, wrong.given->given->value.where);
  const int value = layerOf(b.description, wrong.given->value->where);
  if (use != value) return use < value;
  const std::vector<const ParameterSpec*>& uses = b.uses[*wrong.given->from];
  return wrongUses < uses.size() && !commonSpec(uses);
}

}  // namespace

std::string fromEnvironment(const Binding& b, const std::string& text) {
  const size_t dollar = text.find('$');
  if (dollar == std::string::npos) return text;
  for (const auto& [name, value] : b.environment.texts)
    if (std::string_view(text).substr(dollar + 1) == name) return text.substr(0, dollar) + value;
  return text;
}

Parameters bindParameters(Binding& b, const std::string& owner, const std::string& path,
                          const std::vector<ParameterSpec>& specs,
                          std::span<const ParameterDescription> given, std::vector<Value>& values,
                          uint32_t pass) {
  const size_t first = values.size();
  for (const ParameterSpec& spec : specs) values.push_back(spec.defaultValue);
  for (const ParameterDescription& one : given) {
    const std::string& name = one.given->key;
    const std::string place = json::joinPath(path, name);
    const auto spec =
        std::find_if(specs.begin(), specs.end(), [&](const ParameterSpec& s) { return s.name == name; });
    if (spec != specs.end()) {
      readParameter(b, place, *spec, one, values[first + static_cast<size_t>(spec - specs.begin())]);
      continue;
    }
    if (pass != kNone &&
        blameType(b, pass, one.given->keyWhere, fmt::format("it has no parameter `{}`", name)))
      continue;
    std::vector<std::string> names;
    for (const ParameterSpec& s : specs) names.push_back(s.name);
    report(b, one.given->keyWhere, place, fmt::format("{} has no parameter `{}`", owner, name),
           findParameter(viewParameters(), name)
               ? fmt::format("it belongs to the frame: set `{}` in \"view\" of the graph, or --set view.{}",
                             name, name)
               : remedyFor(name, names));
  }
  return {&specs, &values, first};
}

// The materials are those of the scene unless the graph or the run decides.
void bindViewParameters(Binding& b, std::vector<Value>& values) {
  b.graph.view = bindParameters(b, "the view", "view", viewParameters(), b.description.view, values);
  const auto& given = b.description.view;
  for (size_t i = 0; i < viewParameters().size(); ++i) {
    const std::string& name = viewParameters()[i].name;
    if (std::any_of(given.begin(), given.end(), [&](const auto& g) { return g.given->key == name; }))
      continue;
    for (const auto& [text, value] : b.environment.texts)
      if (text == "scene." + name) values[i] = value;
  }
}

void reportWrongValues(Binding& b) {
  std::map<uint32_t, size_t> counts;  // of wrong uses, by graph parameter
  for (const WrongValue& wrong : b.wrongValues)
    if (wrong.given->from) ++counts[*wrong.given->from];
  for (const WrongValue& wrong : b.wrongValues) {
    const std::optional<uint32_t>& from = wrong.given->from;
    if (!from || isWrongUse(b, wrong, counts[*from])) {
      reportWrong(b, wrong.given->given->value.where, wrong.path, wrong.spec->name, *wrong.spec, wrong);
      continue;
    }
    if (std::exchange(counts[*from], 0) == 0) continue;  // has been reported
    const GraphParameter& parameter = b.description.graphParameters[*from];
    reportWrong(b, wrong.given->value->where, parameter.path, parameter.declared->key,
                commonSpec(b.uses[*from]).value_or(*wrong.spec), wrong);
  }
}

}  // namespace fovea::graph::detail
