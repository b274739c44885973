// Part of bind(): decides which of several things that contradict each other a message is about.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/binding.h"
#include "framework/graph/pass/evaluate.h"

namespace fovea::graph::detail {
namespace {

const Registry& registryOf(const Binding& b) {
  return b.environment.registry ? *b.environment.registry : Registry::global();
}

// The types that a graph parameter may name, or "" if none fits.
std::string fittingRemedy(const Binding& b, uint32_t parameter) {
  std::vector<std::string> endings = typeEndings(b.description, registryOf(b), parameter);
  if (b.suggest) {
    const std::vector<std::string> fitting =
        fittingValues(b.description, b.environment, parameter, endings, b.diagnostics);
    if (!fitting.empty()) endings = fitting;
  }
  return fmt::format("{}", fmt::join(endings, ", "));
}

}  // namespace

const json::Position& placeOfType(const Binding& b, uint32_t pass) {
  const PassDescription& from = b.description.passes[pass];
  if (!from.typeFrom) return from.type ? from.type->where : from.written->keyWhere;
  const GraphParameter& parameter = b.description.graphParameters[*from.typeFrom];
  return parameter.value.value ? parameter.value.value->where : parameter.declared->keyWhere;
}

bool blameType(Binding& b, uint32_t pass, const json::Position& other, std::string misfit) {
  if (layerOf(b.description, placeOfType(b, pass)) >= layerOf(b.description, other)) return false;
  std::vector<std::string>& misfits = b.misfits[pass];
  if (std::ranges::count(misfits, misfit) == 0) misfits.push_back(std::move(misfit));
  return true;
}

void blameAlong(Binding& b, const Port& port, std::string message, std::string remedy) {
  const Port* wire = &port;
  std::vector<uint32_t> passes = {port.pass};
  for (uint32_t at = port.source; at != kNone && passes.size() <= b.graph.passes.size();) {
    const Port& source = b.ports[at];
    passes.push_back(source.pass);
    if (source.wire) wire = &nearestWire(b, {wire, &source});
    at = source.source;
  }
  uint32_t pass = kNone;
  for (const uint32_t p : passes)
    if (p != kNone && (pass == kNone || layerOf(b.description, placeOfType(b, p)) <
                                            layerOf(b.description, placeOfType(b, pass))))
      pass = p;
  if (pass == kNone || !blameType(b, pass, wire->wire->where(), message))
    reportWire(b, *wire, std::move(message), std::move(remedy));
}

const Port& nearestWire(const Binding& b, std::initializer_list<const Port*> ports) {
  const Port* nearest = *ports.begin();
  for (const Port* port : ports)
    if (layerOf(b.description, port->wire->where()) < layerOf(b.description, nearest->wire->where()))
      nearest = port;
  return *nearest;
}

std::optional<GivenValue> nearestValue(const Binding& b, uint32_t pass,
                                       const std::vector<std::string>& names) {
  const PassDescription& from = b.description.passes[pass];
  std::optional<GivenValue> nearest;
  const auto consider = [&](const ParameterDescription& given, const std::string& name, auto pathOf) {
    if (std::ranges::count(names, name) == 0) return;
    const json::Position& where = given.value->where;
    if (nearest && layerOf(b.description, where) >= layerOf(b.description, nearest->where)) return;
    if (given.from) {
      const GraphParameter& parameter = b.description.graphParameters[*given.from];
      nearest = {where, parameter.path, parameter.declared->key};
    } else {
      nearest = {where, pathOf(), given.given->key};
    }
  };
  for (uint32_t i = 0; i < from.parameterCount; ++i) {
    const ParameterDescription& given = b.description.parameters[from.firstParameter + i];
    consider(given, given.given->key, [&] { return passPath(b, pass, "params." + given.given->key); });
  }
  for (const ParameterDescription& given : b.description.view)
    consider(given, std::string(kViewPrefix) + given.given->key,
             [&] { return json::joinPath("view", given.given->key); });
  return nearest;
}

std::optional<GivenValue> nearestSource(Binding& b, uint32_t pass, const SizeExpr& size) {
  std::optional<GivenValue> nearest;
  std::vector<std::pair<uint32_t, const SizeExpr*>> sizes = {
      {pass, &size}};  // each once, with the pass it belongs to
  for (size_t i = 0; i < sizes.size(); ++i) {
    const auto [of, expression] = sizes[i];
    std::vector<std::string> parameters;
    for (const SizeExpr::Term& term : expression->terms()) {
      if (term.op == SizeExpr::Op::Parameter || term.op == SizeExpr::Op::ParameterIs)
        parameters.push_back(term.name);
      if (term.op < SizeExpr::Op::PortWidth || term.op > SizeExpr::Op::PortCount) continue;
      const uint32_t r = resourceNamed(b, of, term.name);
      if (r == kNone || b.origins[r].pass == kNone) continue;
      const std::pair next(b.origins[r].pass, &expressionOf(b.origins[r].spec->resource, term.op));
      if (std::ranges::count(sizes, next) == 0) sizes.push_back(next);
    }
    std::optional<GivenValue> given = nearestValue(b, of, parameters);
    if (given && (!nearest || layerOf(b.description, given->where) < layerOf(b.description, nearest->where)))
      nearest = std::move(given);
  }
  return nearest;
}

void reportUnwired(Binding& b) {
  constexpr size_t kMost = 20;  // with words on what would fit, for which the whole graph is searched
  size_t reported = 0;
  for (auto& [p, inputs] : b.unwired) {
    const PassDescription& pass = b.description.passes[p];
    const bool known = b.misfits.contains(p);
    std::string names, remedy;
    bool blamed = true;
    for (const Port* port : inputs) {
      const std::string& name = port->spec->name;
      const std::string misfit = fmt::format("its input `{}` is not wired", name);
      if (known)
        b.misfits[p].push_back(misfit);
      else
        blamed &= blameType(b, p, pass.written->keyWhere, misfit);
      if (blamed) continue;
      names += fmt::format("{}`{}` ({})", names.empty() ? "" : ", ", name, describeWanted(*port->spec));
      if (!b.suggest || reported >= kMost) continue;
      remedy += remedy.empty() ? "" : "; ";
      remedy += (inputs.size() > 1 ? fmt::format("for `{}`, ", name) : "") + missingRemedy(b, *port);
    }
    if (blamed) continue;
    ++reported;
    report(b, pass.written->keyWhere, passPath(b, p, "inputs"),
           fmt::format("`{}`: the input{} {} {} not wired", pass.written->key, inputs.size() > 1 ? "s" : "",
                       names, inputs.size() > 1 ? "are" : "is"),
           remedy);
  }
}

void reportRemovals(Binding& b) {
  constexpr size_t kMost = 5;
  for (Removal& removal : b.removals) {
    std::vector<std::string>& places = removal.neededAt;
    if (places.empty()) continue;
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    const size_t more = places.size() > kMost ? places.size() - kMost : 0;
    places.resize(places.size() - more);
    report(b, removal.where, removal.path,
           fmt::format("`null` removes {}, which is needed: {}{}", removal.path, fmt::join(places, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : std::string()),
           "leave it, or remove or rewire what needs it");
  }
}

void reportMisfits(Binding& b) {
  struct Misfit {
    std::vector<std::string> all;
    std::string value;
  };
  std::map<uint32_t, Misfit> byParameter;
  for (const auto& [pass, misfits] : b.misfits) {
    const PassDescription& from = b.description.passes[pass];
    if (!from.typeFrom) {
      report(b, from.type->where, passPath(b, pass, "type"),
             fmt::format("`{}` does not fit the wiring of pass `{}`: {}", from.type->string,
                         from.written->key, fmt::join(misfits, "; ")),
             "give another type, or wire what reads this pass and what it reads anew");
      continue;
    }
    if (typeEndings(b.description, registryOf(b), *from.typeFrom).empty()) {
      report(b, from.type->where, passPath(b, pass, "type"),
             fmt::format("no pass type begins with `{}`", startOfType(from)), "`fovea passes` lists them");
      continue;
    }
    auto& [all, value] = byParameter[*from.typeFrom];
    value = from.type->string.substr(startOfType(from).size());
    if (misfits.empty())
      all.push_back(fmt::format("there is no pass type `{}`", from.type->string));
    else
      all.push_back(fmt::format("`{}` does not fit: {}", from.type->string, fmt::join(misfits, "; ")));
  }
  b.misfits.clear();
  for (const auto& [index, misfit] : byParameter) {
    const auto& [misfits, value] = misfit;
    const GraphParameter& parameter = b.description.graphParameters[index];
    const std::string allowed = fittingRemedy(b, index);
    const std::string nearest = nearestName(value, typeEndings(b.description, registryOf(b), index));
    report(b, parameter.value.value->where, parameter.path,
           fmt::format("parameter `{}`: expected one of {}, found `{}`: {}", parameter.declared->key, allowed,
                       value, fmt::join(misfits, "; ")),
           nearest.empty() || nearest == value ? std::string() : fmt::format("did you mean `{}`?", nearest));
  }
}

// ---- Overrides ---------------------------------------------------------------------------------------

namespace {

std::string suggestion(std::string_view word, const std::vector<std::string>& names, const char* otherwise) {
  const std::string nearest = nearestName(word, names);
  if (!nearest.empty()) return fmt::format("did you mean `{}`?", nearest);
  return names.empty() ? std::string() : fmt::format("{}{}", otherwise, fmt::join(names, ", "));
}

void reportUnusedOverride(Binding& b, const Override& o) {
  const json::Position where{std::make_shared<const std::string>(o.typed())};
  const size_t dot = o.name.rfind('.');
  const std::string target = dot == std::string::npos ? std::string() : o.name.substr(0, dot);
  const std::string name = dot == std::string::npos ? o.name : o.name.substr(dot + 1);
  std::vector<std::string> ofGraph, ofPasses, targets = b.description.instances;
  for (const GraphParameter& p : b.description.graphParameters)
    if (p.target == target) ofGraph.push_back(p.name());
  for (const BoundPass& pass : b.graph.passes) {
    targets.push_back(pass.name);
    if (pass.declaration && findParameter(pass.declaration->parameters, name))
      ofPasses.push_back(pass.name + "." + name);
  }
  const auto isTarget = [&](const std::string& word) { return std::ranges::count(targets, word) > 0; };
  if (!target.empty() && isTarget(target))  // that of a pass would have been used
    return report(b, where, {}, fmt::format("the sub-graph `{}` has no parameter `{}`", target, name),
                  suggestion(o.name, ofGraph, "there is: "));
  if (!target.empty())
    return report(b, where, {}, fmt::format("the graph has no pass `{}`", target),
                  ofPasses.empty() || !nearestName(target, targets).empty()
                      ? suggestion(target, targets, "there is: ")
                      : fmt::format("these have a parameter `{}`: {}", name, fmt::join(ofPasses, ", ")));
  if (findParameter(viewParameters(), name))
    return report(b, where, {}, fmt::format("`{}` belongs to the frame, not to the graph", name),
                  fmt::format("give --set view.{}={}", name, o.value));
  if (isTarget(name))
    return report(b, where, {}, fmt::format("`{}` is a pass, which is not set as a whole", name),
                  fmt::format("give --set {}.PARAMETER=VALUE", name));
  const bool misspelt = !nearestName(name, ofGraph).empty();
  report(b, where, {}, fmt::format("the graph has no parameter `{}`", name),
         misspelt || ofPasses.empty() ? suggestion(name, ofGraph, "there is: ")
                                      : fmt::format("passes have it: {}", fmt::join(ofPasses, ", ")));
}

}  // namespace

void reportUnusedOverrides(Binding& b) {
  for (const Override& o : b.description.unusedOverrides) reportUnusedOverride(b, o);
}

}  // namespace fovea::graph::detail
