// Resolve, wires: turns "pass.port@previous", as spelled in its own document, into a wire between flat passes.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/resolve/expand.h"

namespace fovea::graph::detail {
namespace {

// "pass.port.member@previous", split into its parts.
struct WireParts {
  std::string_view names[3];
  uint32_t count = 0;     // 4 if there are more than three
  bool open = false;      // a name is empty
  std::string_view rest;  // everything from the '@' on

  std::string_view pass() const { return names[0]; }
  std::string_view port() const { return names[1]; }
  std::string_view member() const { return names[2]; }
};

constexpr std::string_view kPrevious = "@previous";
constexpr int kMaxHops = 64;  // through sub-graph inputs and outputs

WireParts split(std::string_view text) {
  WireParts parts;
  const size_t end = std::min(text.find('@'), text.size());
  parts.rest = text.substr(end);
  text = text.substr(0, end);
  for (bool more = true; more;) {
    const size_t dot = text.find('.');
    const std::string_view name = text.substr(0, dot);
    parts.open |= name.empty();
    if (parts.count < 3) parts.names[parts.count] = name;
    if (parts.count < 4) ++parts.count;
    more = dot != std::string_view::npos;
    if (more) text.remove_prefix(dot + 1);
  }
  return parts;
}

bool resolveWire(Expansion& all, Scope& scope, const json::Value& value, WireDescription& wire, int depth);

// Keeps the part of the wire that is nearest to the user.
void passThrough(const Expansion& all, const Scope& scope, const json::Value& part, WireDescription& wire) {
  if (layerOf(all.description, part.where) >= layerOf(all.description, wire.where())) return;
  wire.nearest = &part;
  wire.nearestPath = pathOf(scope, part);
}

bool resolveInput(Expansion& all, Scope& scope, const json::Value& value, const WireParts& parts,
                  WireDescription& wire, int depth) {
  Scope::Input* input = parts.count > 1 ? scope.findInput(parts.port()) : nullptr;
  if (!input && parts.count == 1 && scope.inputs.size() == 1) input = &scope.inputs[0];
  if (!input) {
    std::vector<std::string> names;
    if (scope.isBroken(value.string.substr(0, value.string.find('@')))) return false;
    for (const Scope::Input& i : scope.inputs) names.push_back("inputs." + i.declared->key);
    report(all, scope, value, fmt::format("the graph has no input `{}`", value.string),
           nearestRemedy(value.string, names));
    return false;
  }
  input->used = true;
  wire.external = input->external;
  if (!scope.parent) return true;
  if (input->wire) passThrough(all, *scope.parent, *input->wire, wire);
  wire.open = !input->wire && input->optional;
  return input->wire && resolveWire(all, *scope.parent, *input->wire, wire, depth + 1);
}

bool resolveInstance(Expansion& all, Scope& scope, Scope& child, const json::Value& value,
                     const WireParts& parts, WireDescription& wire, int depth) {
  const json::Value* outputs = child.document->find("outputs");
  const std::vector<json::Member> none;
  const std::vector<json::Member>& members = outputs && outputs->isObject() ? outputs->members : none;
  const json::Member* found = nullptr;
  for (const json::Member& m : members)
    if (parts.count > 1 ? m.key == parts.port() : members.size() == 1) found = &m;
  if (!found) {
    std::vector<std::string> names;
    for (const json::Member& m : members) names.push_back(fmt::format("{}.{}", parts.pass(), m.key));
    report(all, scope, value,
           parts.count > 1
               ? fmt::format("the sub-graph `{}` has no output `{}`", parts.pass(), parts.port())
               : fmt::format("the sub-graph `{}` has {} outputs: name one", parts.pass(), members.size()),
           nearestRemedy(value.string, names));
    return false;
  }
  passThrough(all, child, found->value, wire);
  // An output that is no text is reported with the outputs.
  return found->value.isString() && resolveWire(all, child, found->value, wire, depth + 1);
}

// What is written after the name of a sub-graph's input or output applies to the value that it stands for.
bool combine(Expansion& all, const Scope& scope, const json::Value& value, std::string_view member,
             bool previous, WireDescription& wire) {
  if (!member.empty() && !wire.member.empty()) {
    report(all, scope, value, fmt::format("`{}`: that is one member already", value.string));
    return false;
  }
  if (!member.empty()) wire.member = member;
  if (previous && wire.previous) {
    report(all, scope, value, fmt::format("`{}`: that is last frame's value already", value.string),
           "only one frame back is kept");
    return false;
  }
  wire.previous |= previous;
  return true;
}

void reportNoPass(Expansion& all, const Scope& scope, const json::Value& value, std::string_view name) {
  const bool inner = name.find('/') != std::string::npos;  // a pass inside an instance, by its full name
  std::vector<std::string> names = {"inputs"};
  for (const auto& [instance, position] : scope.instances) names.push_back(instance);
  for (const PassDescription& p : all.description.passes) {
    const bool own =
        p.name.starts_with(scope.prefix) && p.name.find('/', scope.prefix.size()) == std::string::npos;
    if (own || inner) names.push_back(own ? p.name.substr(scope.prefix.size()) : p.name);
  }
  std::sort(names.begin(), names.end());
  report(all, scope, value, fmt::format("no pass `{}`", name), nearestRemedy(name, names));
}

// False if there is nothing to wire: because of a mistake, which is reported, or because an optional input is open.
bool resolveWire(Expansion& all, Scope& scope, const json::Value& value, WireDescription& wire, int depth) {
  const auto mistake = [&](std::string message, std::string remedy = {}) {
    report(all, scope, value, std::move(message), std::move(remedy));
    return false;
  };
  if (depth > kMaxHops) return mistake("this wire runs in a circle through sub-graphs");
  const WireParts parts = split(value.string);
  const bool previous = parts.rest == kPrevious;
  if (!previous && !parts.rest.empty())
    return mistake(fmt::format("`{}`: only `@previous` may follow a port", value.string));
  if (parts.count > 3 || parts.open)
    return mistake(fmt::format("`{}` is no wire", value.string),
                   "write pass.port, pass, or pass.port.member; @previous after it means last frame's value");
  const std::string_view name = parts.pass();
  if (name == "inputs")
    return resolveInput(all, scope, value, parts, wire, depth) &&
           combine(all, scope, value, parts.member(), previous, wire);
  // "blur" is the pass "left/blur" of the graph if it is written in the sub-graph `left`.
  const auto pass = all.passes.find(std::string(scope.prefix).append(name));
  if (pass != all.passes.end()) {
    wire.pass = pass->second;
    wire.port = parts.port();
    wire.member = parts.member();
    wire.previous = previous;
    return true;
  }
  if (const auto child = scope.instances.find(name); child != scope.instances.end())
    return resolveInstance(all, scope, *child->second, value, parts, wire, depth) &&
           combine(all, scope, value, parts.member(), previous, wire);
  // A name that matches nothing may contain dots.
  if (scope.isBroken(name) || scope.isBroken(value.string.substr(0, value.string.find('@')))) return false;
  if (!blameRemoval(all, scope, fmt::format("passes.{}", name), value.where, pathOf(scope, value)))
    reportNoPass(all, scope, value, name);
  return false;
}

void resolveOutputs(Expansion& all) {
  for (Scope& scope : all.scopes) {
    const json::Value* outputs = scope.document->find("outputs");
    if (!outputs || !outputs->isObject()) continue;
    for (const json::Member& member : outputs->members) {
      WireDescription wire{&member};
      if (!member.value.isString())
        report(all, scope, member.value,
               fmt::format("expected a wire such as \"pass.port\", found {}", member.value.describe()));
      else if (!resolveWire(all, scope, member.value, wire, 0) || scope.parent)
        continue;
      else if (wire.external || wire.previous)
        report(all, scope, member.value, "an output of the graph is what a pass writes in this frame",
               wire.previous ? "drop `@previous`" : "wire it to a pass");
      else
        all.description.outputs.push_back(wire);
    }
  }
}

}  // namespace

void resolveWires(Expansion& all) {
  std::vector<WireDescription>& wires = all.description.wires;
  wires.reserve(all.description.passes.size());
  for (size_t p = 0; p < all.origins.size(); ++p) {
    const auto [scope, inputs] = all.origins[p];
    PassDescription& pass = all.description.passes[p];
    pass.firstInput = static_cast<uint32_t>(wires.size());
    if (!inputs) continue;
    for (const json::Member& input : inputs->members) {
      WireDescription wire{&input};
      wire.broken = !input.value.isString() || !resolveWire(all, *scope, input.value, wire, 0);
      if (!wire.open) wires.push_back(wire);
    }
    pass.inputCount = static_cast<uint32_t>(wires.size()) - pass.firstInput;
  }
  resolveOutputs(all);
}

}  // namespace fovea::graph::detail
