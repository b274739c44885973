// Resolve, wires: turns "pass.port@previous", as spelled in its own document, into a wire between flat passes.
#include <fmt/format.h>

#include <algorithm>

#include "framework/graph/compile/expand.h"

namespace fovea::graph::detail {
namespace {

constexpr std::string_view kPrevious = "@previous";
constexpr int kMaxHops = 64;  // through sub-graph inputs and outputs

WireParts split(std::string_view text) {
  WireParts parts;
  for (size_t first = 0;;) {
    size_t at = first;
    while (at < text.size() && text[at] != '.' && text[at] != '@') ++at;
    parts.open |= at == first;
    if (parts.count < 3) parts.names[parts.count] = text.substr(first, at - first);
    if (parts.count < 4) ++parts.count;
    first = at + 1;
    if (at < text.size() && text[at] == '.') continue;
    parts.rest = text.substr(at);
    return parts;
  }
}

Symbol findJoined(const SymbolTable& symbols, const std::string& prefix, std::string_view name) {
  return symbols.find(prefix + std::string(name));
}

}  // namespace

inline void Expander::describeWire(const json::Value& value, const Place& keyPlace, WireDescription& wire) {
  wire.written = keep(value.string);
  wire.keyPlace = keyPlace;
  wire.place = place(value.where);
}

void Expander::resolveWires() {
  isPass_ = scratch_.array<uint8_t>(description_.symbols.size());
  for (const PassDescription& pass : description_.passes) isPass_[pass.name] = 1;
  rawFirst_.push_back(static_cast<uint32_t>(rawWires_.size()));
  description_.wires.reserve(rawWires_.size());
  const Trail passesPath("passes");
  for (size_t p = 0; p < description_.passes.size(); ++p) {
    PassDescription& pass = description_.passes[p];
    pass.firstInput = static_cast<uint32_t>(description_.wires.size());
    for (uint32_t i = rawFirst_[p]; i < rawFirst_[p + 1]; ++i) {
      const RawWire& raw = rawWires_[i];
      WireDescription& wire = description_.wires.emplace_back();
      const Trail passPath(passesPath, raw.pass), inputsPath(passPath, "inputs"),
          path(inputsPath, raw.target);
      if (!resolveWire(*raw.scope, *raw.value, path, wire, 0)) {
        description_.wires.pop_back();
        continue;
      }
      wire.target = raw.target;
      describeWire(*raw.value, raw.keyPlace, wire);
    }
    pass.inputCount = static_cast<uint32_t>(description_.wires.size()) - pass.firstInput;
  }
  resolveOutputs();
}

void Expander::resolveOutputs() {
  for (Scope& scope : scopes_) {
    const json::Value* outputs = scope.document->find("outputs");
    if (!outputs || !outputs->isObject()) continue;
    for (const json::Member& member : outputs->members) {
      const Trail outputsPath("outputs"), path(outputsPath, member.key);
      if (!member.value.isString()) {
        error(member.value.where, path,
              fmt::format("expected a wire such as \"pass.port\", found {}", member.value.describe()));
        continue;
      }
      WireDescription wire;
      if (!resolveWire(scope, member.value, path, wire, 0) || scope.parent) continue;
      if (wire.external != kNone || wire.previous) {
        error(member.value.where, path, "an output of the graph is what a pass writes in this frame",
              wire.previous ? "drop `@previous`" : "wire it to a pass");
        continue;
      }
      wire.target = keep(member.key);
      describeWire(member.value, place(member.keyWhere), wire);
      description_.outputs.push_back(wire);
    }
  }
}

// The pass that a document calls `name`; kNone if there is none.
inline Symbol Expander::findPass(const Scope& scope, std::string_view name) const {
  const SymbolTable& symbols = description_.symbols;
  const Symbol pass = scope.prefix.empty() ? symbols.find(name) : findJoined(symbols, scope.prefix, name);
  return pass < isPass_.size() && isPass_[pass] ? pass : kNone;
}

// False if there is nothing to wire, because of a mistake (which is reported) or because an optional input is open.
bool Expander::resolveWire(Scope& scope, const json::Value& value, const Trail& path, WireDescription& wire,
                           int depth) {
  if (depth > kMaxHops)
    return error(value.where, path, "this wire runs in a circle through sub-graphs"), false;
  const WireParts parts = split(value.string);
  const bool previous = parts.rest == kPrevious;
  if (!previous && !parts.rest.empty())
    return error(value.where, path, fmt::format("`{}`: only `@previous` may follow a port", value.string)),
           false;
  if (parts.count > 3 || parts.open)
    return error(value.where, path, fmt::format("`{}` is no wire", value.string),
                 "write pass.port, pass, or pass.port.member; @previous after it means last frame's value"),
           false;
  const std::string_view name = parts.pass();
  if (sameText(name, "inputs")) {
    if (!resolveInput(scope, value, path, parts, wire, depth)) return false;
    return combine(value, path, parts.member(), previous, wire);
  }
  if (!scope.instances.empty()) {
    if (const auto child = scope.instances.find(name); child != scope.instances.end()) {
      if (!resolveInstance(*child->second, value, path, parts, wire, depth)) return false;
      return combine(value, path, parts.member(), previous, wire);
    }
  }
  wire.pass = findPass(scope, name);
  if (wire.pass == kNone) {
    const bool inner = name.find('/') != std::string::npos;  // a pass inside an instance, by its full name
    std::vector<std::string> names = {"inputs"};
    for (const auto& [instance, position] : scope.instances) names.push_back(instance);
    for (const PassDescription& p : description_.passes) {
      const std::string_view full = description_.symbols[p.name];
      const bool own =
          full.starts_with(scope.prefix) && full.find('/', scope.prefix.size()) == std::string::npos;
      if (own || inner) names.emplace_back(own ? full.substr(scope.prefix.size()) : full);
    }
    std::sort(names.begin(), names.end());
    return error(value.where, path, fmt::format("no pass `{}`", name), nearestRemedy(name, names)), false;
  }
  if (parts.count > 1) wire.port = intern(parts.port());
  if (parts.count > 2) wire.member = intern(parts.member());
  wire.previous = previous;
  return true;
}

bool Expander::resolveInput(Scope& scope, const json::Value& value, const Trail& path, const WireParts& parts,
                            WireDescription& wire, int depth) {
  Scope::Input* input = parts.count > 1 ? scope.findInput(parts.port()) : nullptr;
  if (!input && parts.count == 1 && scope.inputs.size() == 1) input = &scope.inputs[0];
  if (!input) {
    std::vector<std::string> names;
    for (const Scope::Input& i : scope.inputs) names.push_back("inputs." + i.name);
    return error(value.where, path, fmt::format("the graph has no input `{}`", value.string),
                 nearestRemedy(value.string, names)),
           false;
  }
  input->used = true;
  if (!scope.parent) {
    wire.external = input->external;
    return true;
  }
  if (!input->wire) return false;
  return resolveWire(*scope.parent, *input->wire, json::joinPath(scope.path, "inputs." + input->name), wire,
                     depth + 1);
}

bool Expander::resolveInstance(Scope& child, const json::Value& value, const Trail& path,
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
    return error(
               value.where, path,
               parts.count > 1
                   ? fmt::format("the sub-graph `{}` has no output `{}`", parts.pass(), parts.port())
                   : fmt::format("the sub-graph `{}` has {} outputs: name one", parts.pass(), members.size()),
               nearestRemedy(value.string, names)),
           false;
  }
  if (!found->value.isString()) return false;  // reported with the outputs
  return resolveWire(child, found->value, json::joinPath("outputs", found->key), wire, depth + 1);
}

// What is written after the name of a sub-graph's output applies to the value that it stands for.
bool Expander::combine(const json::Value& value, const Trail& path, std::string_view member, bool previous,
                       WireDescription& wire) {
  if (!member.empty()) {
    if (wire.member != kNone)
      return error(value.where, path, fmt::format("`{}`: that is one member already", value.string)), false;
    wire.member = intern(member);
  }
  if (previous && wire.previous)
    return error(value.where, path, fmt::format("`{}`: that is last frame's value already", value.string),
                 "only one frame back is kept"),
           false;
  wire.previous = wire.previous || previous;
  return true;
}

}  // namespace fovea::graph::detail
