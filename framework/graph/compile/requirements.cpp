// Bind, requirements: what passes ask of their parameters, and of the presence and the sizes of their inputs.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/binding.h"
#include "framework/graph/compile/schedule.h"
#include "framework/graph/pass/evaluate.h"

namespace fovea::graph::detail {
namespace {

using Op = SizeExpr::Op;

std::optional<int64_t> sizeOf(Binding& b, uint32_t p, const SizeExpr::Term& term) {
  const uint32_t r = resourceNamed(b, p, term.name);
  if (r == kNone) return std::nullopt;
  return quantityOf(b.graph.resources[r].desc, term.op);
}

std::optional<int64_t> valueOf(Binding& b, uint32_t p, const SizeExpr::Term& term) {
  const BoundPass& pass = b.graph.passes[p];
  switch (term.op) {
    case Op::Constant:
      return term.constant;
    case Op::ViewWidth:
      return b.viewExtents[pass.view].width;
    case Op::ViewHeight:
      return b.viewExtents[pass.view].height;
    case Op::Parameter:
      return wholeNumber(pass.parameters, term.name);
    case Op::ParameterIs:
      return pass.parameters.text(term.name) == term.choice;
    case Op::Wired:
      return std::ranges::any_of(b.portsOf(p),
                                 [&](const Port& port) { return port.spec->name == term.name && port.wire; });
    default:
      return sizeOf(b, p, term);
  }
}

// The sizes and numbers that a requirement is about: " (image.width is 24, view.width is 8)".
std::string quantities(Binding& b, uint32_t p, const SizeExpr& condition) {
  std::string text;
  for (const SizeExpr::Term& term : condition.terms()) {
    if (term.op == Op::Constant || term.op > Op::PortCount) continue;
    const ParameterSpec* spec = b.graph.passes[p].parameters.findSpec(term.name);
    if (term.op == Op::Parameter && spec->type != ParameterSpec::Type::Int) continue;
    const std::string one =
        fmt::format("{} is {}", SizeExpr(std::vector{term}).print(), valueOf(b, p, term).value_or(0));
    if (text.find(one) == std::string::npos) text += (text.empty() ? " (" : ", ") + one;
  }
  return text.empty() ? text : text + ")";
}

// Reports at the value or the wire, of those that the requirement is about, that was chosen nearest to the user; or at
// a value from which a size follows, if that is nearer still.
void reportUnmet(Binding& b, uint32_t p, const RequirementSpec& requirement) {
  std::vector<std::string> parameters;
  const Port* wire = nullptr;
  for (const SizeExpr::Term& term : requirement.condition.terms()) {
    if (term.op == Op::Parameter || term.op == Op::ParameterIs) parameters.push_back(term.name);
    const std::string_view name = std::string_view(term.name).substr(0, term.name.find('.'));
    for (const Port& port : b.portsOf(p))
      if (port.wire && port.spec->name == name) wire = wire ? &nearestWire(b, {wire, &port}) : &port;
  }
  json::Position where = b.description.passes[p].written->keyWhere;
  std::string path = passPath(b, p);
  if (wire) where = wire->wire->where(), path = wirePath(b, *wire);
  if (const std::optional<GivenValue> given = nearestValue(b, p, parameters);
      given && (!wire || layerOf(b.description, given->where) <= layerOf(b.description, where)))
    where = given->where, path = given->path;
  if (const std::optional<GivenValue> source = nearestSource(b, p, requirement.condition);
      source && layerOf(b.description, source->where) < layerOf(b.description, where))
    where = source->where, path = source->path;
  if (blameType(b, p, where, requirement.message)) return;
  report(b, where, path,
         fmt::format("pass `{}`: {}{}", b.graph.passes[p].name, requirement.message,
                     quantities(b, p, requirement.condition)),
         requirement.remedy);
}

}  // namespace

void checkRequirements(Binding& b) {
  const Live live = cull(b.graph, makersOfVersions(b.graph));
  for (uint32_t p = 0; p < b.graph.passes.size(); ++p) {
    if (!live.passLive[p]) continue;
    for (const RequirementSpec& requirement : b.graph.passes[p].declaration->requirements) {
      std::string why;
      const auto value = evaluate(requirement.condition, why,
                                  [&](const SizeExpr::Term& term) { return valueOf(b, p, term); });
      if (value == 0) reportUnmet(b, p, requirement);
    }
  }
}

}  // namespace fovea::graph::detail
