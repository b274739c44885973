#include "framework/graph/report/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/fitting.h"

namespace fovea::graph {
namespace {

const Registry& registryOf(const Environment& environment) {
  return environment.registry ? *environment.registry : Registry::global();
}

std::string valueText(const json::Value& value) {
  if (value.isString()) return value.string;
  std::string text = json::print(value);
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

// What takes the value of a parameter, and what it allows.
void collectUses(const Description& description, const Registry& registry, uint32_t parameter,
                 Setting& setting, std::vector<const ParameterSpec*>& specs) {
  const auto use = [&](const ParameterDescription& given, const std::string& owner,
                       const std::vector<ParameterSpec>& known) {
    if (given.from != parameter) return;
    const std::string name = owner + "." + given.given->key;
    if (std::ranges::count(setting.reaches, name) == 0) setting.reaches.push_back(name);
    if (const ParameterSpec* spec = findParameter(known, given.given->key)) specs.push_back(spec);
  };
  for (const ParameterDescription& given : description.view) use(given, "view", viewParameters());
  for (const PassDescription& pass : description.passes) {
    if (pass.typeFrom == parameter) setting.reaches.push_back(pass.name);
    const PassDeclaration* declaration = pass.type ? registry.find(pass.type->string) : nullptr;
    for (uint32_t i = 0; declaration && i < pass.parameterCount; ++i)
      use(description.parameters[pass.firstParameter + i], pass.name, declaration->parameters);
  }
}

// The values among which a user chooses. Of those of a range only the pass knows which fit.
std::vector<std::string> valuesToTry(const ParameterSpec& spec) {
  if (spec.type == ParameterSpec::Type::Bool) return {"false", "true"};
  return spec.choices;
}

// fitting: those of valuesToTry() with which the graph can be bound.
void restrict(ParameterSpec& spec, std::vector<std::string> fitting) {
  const bool both = spec.type == ParameterSpec::Type::Bool && fitting.size() == 2;
  spec.choices = both ? std::vector<std::string>() : std::move(fitting);
}

// The specification of a parameter that no pass takes, such as one for the size of an input, from its value alone.
ParameterSpec specOf(const json::Value& value) {
  using Type = ParameterSpec::Type;
  ParameterSpec spec;
  spec.type = value.isBool()     ? Type::Bool
              : value.isInt()    ? Type::Int
              : value.isNumber() ? Type::Real
                                 : Type::Text;
  return spec;
}

}  // namespace

std::string valueText(const Value& value) {
  if (const bool* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const int64_t* i = std::get_if<int64_t>(&value)) return std::to_string(*i);
  if (const double* d = std::get_if<double>(&value)) return fmt::format("{}", *d);
  return std::get<std::string>(value);
}

std::vector<Setting> declaredSettings(const Description& description, const Registry& registry) {
  std::vector<Setting> list;
  for (uint32_t p = 0; p < description.graphParameters.size(); ++p) {
    const GraphParameter& parameter = description.graphParameters[p];
    if (parameter.value.from != p || !parameter.value.value)
      continue;  // the parent of the sub-graph gives it
    Setting setting{parameter.name(), valueText(*parameter.value.value), {}, {}, p};
    std::vector<const ParameterSpec*> specs;
    collectUses(description, registry, p, setting, specs);
    setting.spec = commonSpec(specs).value_or(specOf(*parameter.value.value));
    std::vector<std::string> choices = typeEndings(description, registry, p);
    if (!choices.empty()) {
      setting.spec = {parameter.declared->key, "the type of " + setting.reaches.front(),
                      ParameterSpec::Type::Choice};
      setting.spec.choices = std::move(choices);
    }
    list.push_back(std::move(setting));
  }
  return list;
}

std::vector<Setting> settings(const Description& description, const Environment& environment) {
  std::vector<Setting> list = declaredSettings(description, registryOf(environment));
  for (Setting& setting : list)
    restrict(setting.spec,
             fittingValues(description, environment, setting.parameter, valuesToTry(setting.spec)));
  return list;
}

ParameterSpec fittingSpec(const Description& description, const Environment& environment, uint32_t pass,
                          const ParameterSpec& spec) {
  std::vector<std::string> values = valuesToTry(spec);
  std::erase_if(values, [&](const std::string& value) {
    Diagnostics messages;
    try {
      bind(withValue(description, pass, spec.name, value), environment, messages, false);
      return false;
    } catch (const Error&) {
      return true;
    }
  });
  ParameterSpec fitting = spec;
  restrict(fitting, std::move(values));
  return fitting;
}

}  // namespace fovea::graph
