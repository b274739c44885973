// Bind: turns names into a checked graph of passes and resources.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/base/hash.h"
#include "framework/graph/compile/binding.h"
#include "framework/graph/pass/evaluate.h"

namespace fovea::graph {
namespace detail {

void report(Binding& b, const json::Position& where, std::string path, std::string message,
            std::string remedy) {
  b.diagnostics.error(where.location(), std::move(path), std::move(message), std::move(remedy));
}

std::string remedyFor(std::string_view name, const std::vector<std::string>& names) {
  const std::string nearest = nearestName(name, names);
  if (!nearest.empty()) return fmt::format("did you mean `{}`?", nearest);
  return names.empty() ? std::string("it has none") : fmt::format("it has: {}", fmt::join(names, ", "));
}

std::string passPath(const Binding& b, uint32_t pass, std::string_view rest) {
  const std::string path = json::joinPath("passes", b.description.passes[pass].written->key);
  return rest.empty() ? path : json::joinPath(path, rest);
}

namespace {

// ---- Parameters --------------------------------------------------------------------------------------

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

std::string rangeText(const ParameterSpec& spec) {
  const char* kind = spec.type == ParameterSpec::Type::Int ? "a whole number" : "a number";
  if (std::isinf(spec.min) && std::isinf(spec.max)) return kind;
  if (std::isinf(spec.max)) return fmt::format("{} of at least {}", kind, spec.min);
  if (std::isinf(spec.min)) return fmt::format("{} of at most {}", kind, spec.max);
  return fmt::format("{} from {} to {}", kind, spec.min, spec.max);
}

std::string describeExpected(const ParameterSpec& spec) {
  switch (spec.type) {
    case ParameterSpec::Type::Bool:
      return "true or false";
    case ParameterSpec::Type::Int:
    case ParameterSpec::Type::Real:
      return rangeText(spec);
    case ParameterSpec::Type::Choice:
      return fmt::format("one of {}", fmt::join(spec.choices, ", "));
    case ParameterSpec::Type::Text:
      return "a text";
  }
  return {};
}

std::string describeGiven(const json::Value& given) {
  if (given.isBool()) return given.boolean ? "true" : "false";
  if (given.isInt()) return fmt::format("{}", given.integer);
  return given.isNumber() ? fmt::format("{}", given.real) : fmt::format("`{}`", given.string);
}

// A text in which what stands for one of the environment's, from its '$' on, is that text.
std::string fromEnvironment(const Binding& b, const std::string& text) {
  const size_t dollar = text.find('$');
  if (dollar == std::string::npos) return text;
  for (const auto& [name, value] : b.environment.texts)
    if (std::string_view(text).substr(dollar + 1) == name) return text.substr(0, dollar) + value;
  return text;
}

// path: of the value in its document.
void readParameter(Binding& b, std::string path, const ParameterSpec& spec, const ParameterDescription& given,
                   Value& out) {
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
  std::string nearest;
  if (spec.type == Type::Choice && value.isString()) nearest = nearestName(value.string, spec.choices);
  report(b, *given.where, std::move(path),
         fmt::format("parameter `{}`: expected {}, found {}", spec.name, describeExpected(spec),
                     describeGiven(value)),
         nearest.empty() ? nearest : fmt::format("did you mean `{}`?", nearest));
}

// Values of all `specs`: the given ones, or else the defaults. owner: who has these parameters, for messages; path: of
// their object in its document.
Parameters bindParameters(Binding& b, const std::string& owner, const std::string& path,
                          const std::vector<ParameterSpec>& specs,
                          std::span<const ParameterDescription> given, std::vector<Value>& values) {
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

// What belongs to the frame. Its materials are those of the scene unless the graph or the run decides.
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

// ---- Passes ------------------------------------------------------------------------------------------

void openFirstView(Binding& b) {
  const auto& views = b.environment.views;
  b.graph.views.push_back(views.empty() ? "main" : views[0].first);
  b.viewExtents.push_back(views.empty() ? VkExtent2D{1, 1} : views[0].second);
}

bool dependsOnView(const PassDeclaration& declaration) {
  if (declaration.usesView) return true;
  for (const PortSpec& port : declaration.ports)
    for (const MemberSpec& member : port.members)
      for (const SizeExpr* size : {&member.resource.width, &member.resource.height, &member.resource.count})
        for (const SizeExpr::Term& term : size->terms())
          if (term.op == SizeExpr::Op::ViewWidth || term.op == SizeExpr::Op::ViewHeight) return true;
  return false;
}

void bindView(Binding& b, uint32_t p) {
  BoundPass& pass = b.graph.passes[p];
  const PassDescription& from = b.description.passes[p];
  const json::Position& where = from.ownView ? from.ownView->where : from.written->keyWhere;
  std::vector<std::string>& views = b.graph.views;
  const auto at = std::find(views.begin(), views.end(), *from.view);
  if (at != views.end()) {
    pass.view = static_cast<uint32_t>(at - views.begin());
  } else {
    const auto known = std::find_if(b.environment.views.begin(), b.environment.views.end(),
                                    [&](const auto& view) { return view.first == *from.view; });
    if (known == b.environment.views.end()) {
      std::vector<std::string> names;
      for (const auto& [view, extent] : b.environment.views) names.push_back(view);
      if (names.empty()) names.push_back("main");
      return report(b, where, passPath(b, p, "view"), fmt::format("no view `{}`", *from.view),
                    fmt::format("there is: {}", fmt::join(names, ", ")));
    }
    pass.view = static_cast<uint32_t>(views.size());
    views.emplace_back(*from.view);
    b.viewExtents.push_back(known->second);
  }
  if (from.ownView && !dependsOnView(*pass.declaration))
    report(b, where, passPath(b, p, "view"),
           fmt::format("`{}` passes do not look through a camera", pass.declaration->type), "remove `view`");
}

const PassDeclaration* findType(Binding& b, const Registry& registry, uint32_t p) {
  const json::Value* type = b.description.passes[p].type;
  if (!type) return nullptr;
  const std::string name = fromEnvironment(b, type->string);
  const PassDeclaration* declaration = registry.find(name);
  if (declaration) return declaration;
  const std::string nearest = nearestName(name, registry.types());
  report(b, type->where, passPath(b, p, "type"), fmt::format("no pass type `{}`", name),
         nearest.empty()
             ? std::string(
                   "`fovea passes` lists them; a program of yours has those that it registers, the stock "
                   "ones with fovea::passes::registerAll()")
             : fmt::format("did you mean `{}`?", nearest));
  return nullptr;
}

void declarePasses(Binding& b, std::vector<Value>& values) {
  const Registry& registry = b.environment.registry ? *b.environment.registry : Registry::global();
  const auto count = static_cast<uint32_t>(b.description.passes.size());
  b.graph.passes.resize(count);
  values.reserve(b.description.parameters.size() + count);  // estimate: one default per pass
  bindViewParameters(b, values);
  b.ports.reserve(b.description.wires.size() + 2 * count);  // estimate: all inputs wired, two outputs each
  bool effects = false;
  for (uint32_t p = 0; p < count; ++p) {
    BoundPass& pass = b.graph.passes[p];
    pass.name = b.description.passes[p].name;
    pass.declaration = findType(b, registry, p);
    b.firstPort.push_back(static_cast<uint32_t>(b.ports.size()));
    if (!pass.declaration) continue;
    if (b.description.passes[p].view) bindView(b, p);
    const PassDescription& from = b.description.passes[p];
    pass.parameters = bindParameters(
        b, fmt::format("`{}`", pass.declaration->type), passPath(b, p, "params"),
        pass.declaration->parameters,
        std::span(b.description.parameters).subspan(from.firstParameter, from.parameterCount), values);
    uint16_t index = 0;
    for (const PortSpec& spec : pass.declaration->ports) b.ports.push_back({&spec, p, index++});
    effects |= pass.declaration->sideEffects;
  }
  b.firstPort.push_back(static_cast<uint32_t>(b.ports.size()));
  if (b.description.outputs.empty() && !effects && !b.diagnostics.hasErrors())
    b.diagnostics.error(b.description.start, "outputs", "the graph has no outputs, so nothing would run",
                        "add \"outputs\": {\"image\": \"pass.port\"}");
}

// Marks a pass and those that it reads from.
void spare(Binding& b, uint32_t pass) {
  if (std::exchange(b.graph.passes[pass].spared, true)) return;
  for (const Port& port : b.portsOf(pass))
    if (port.source != kNone) spare(b, b.ports[port.source].pass);
}

// Inputs that a pass does not use with these parameters count as not wired. Their wires have been checked all the same.
void openUnusedInputs(Binding& b) {
  for (Port& port : b.ports) {
    if (!port.wire) continue;
    const Parameters& parameters = b.graph.passes[port.pass].parameters;
    if (holds(port.spec->condition, parameters)) continue;
    if (port.source != kNone) spare(b, b.ports[port.source].pass);
    port.wire = nullptr;
    port.source = kNone;
    port.value = {};
  }
}

// ---- Resources and accesses --------------------------------------------------------------------------

void makeExternals(Binding& b) {
  for (const ExternalDescription& external : b.description.externals) {
    b.firstOfExternal.push_back(static_cast<uint32_t>(b.graph.resources.size()));
    for (size_t m = 0; m < external.members.size(); ++m) {
      BoundResource& resource = b.graph.resources.emplace_back();
      b.origins.emplace_back();
      resource.name = external.name;
      if (!external.members[m].empty()) resource.name += "." + external.members[m];
      resource.external = true;
      resource.desc = external.resources[m];
      if (resource.desc.kind != ResourceKind::Image) continue;
      if (resource.desc.width == 0) resource.desc.width = b.viewExtents[0].width;
      if (resource.desc.height == 0) resource.desc.height = b.viewExtents[0].height;
    }
  }
}

void makeResources(Binding& b) {
  size_t count = b.graph.resources.size();
  for (const Port& port : b.ports)
    if (makes(*port.spec)) count += port.spec->members.size();
  b.graph.resources.reserve(count);
  b.origins.reserve(count);
  b.versions.reserve(count);
  for (Port& port : b.ports) {
    const PortSpec& spec = *port.spec;
    if (!makes(spec)) continue;
    port.value = {static_cast<uint32_t>(b.graph.resources.size()), static_cast<uint32_t>(spec.members.size()),
                  &spec};
    port.state = Port::State::Known;
    port.firstVersion = static_cast<uint32_t>(b.versions.size());
    for (const MemberSpec& member : spec.members) {
      BoundResource& resource = b.graph.resources.emplace_back();
      resource.name.append(b.graph.passes[port.pass].name).append(1, '.').append(spec.name);
      if (!member.name.empty()) resource.name.append(1, '.').append(member.name);
      resource.lifetime = spec.lifetime;
      resource.versions = 1;
      b.versions.push_back(1);
      b.origins.push_back({port.pass, &member});
    }
  }
}

bool tracesOnHost(const Binding& b, const Port& port) {
  return b.graph.raysOnHost && b.graph.passes[port.pass].declaration->tracesRays;
}

// A pass that traces rays on the host may reach its resources through copies.
Usage usageOf(const Binding& b, const Port& port, const MemberSpec& member, bool reads, bool writes) {
  if (!tracesOnHost(b, port)) return member.usage;
  return member.usage | (reads || writes ? Usage::TransferRead : Usage::None) |
         (writes ? Usage::TransferWrite : Usage::None);
}

void addAccesses(Binding& b, const Port& port, std::vector<Access>& accesses) {
  const PortSpec& spec = *port.spec;
  const bool input = spec.direction == Direction::Input, inout = spec.direction == Direction::InOut;
  for (uint32_t m = 0; m < spec.members.size(); ++m) {
    const uint32_t r = resourceOf(b, port, m);
    if (r == kNone) continue;
    BoundResource& resource = b.graph.resources[r];
    Access access;
    access.resource = r;
    access.port = port.index;
    access.member = static_cast<uint16_t>(m);
    access.reads = input || inout || spec.lifetime != Lifetime::Transient;  // previous contents matter
    access.writes = !input;
    access.usage = usageOf(b, port, spec.members[m], access.reads, access.writes);
    resource.usage |= static_cast<uint32_t>(access.usage);
    resource.onHost |= tracesOnHost(b, port);
    access.previous = port.previous();
    if (input && !access.previous)
      access.version = versionSeen(b, port, r);
    else if (!input)  // there is no version if the port is part of a cycle that has been reported
      access.version =
          port.firstVersion == kNone ? 1 : b.versions[port.firstVersion + (r - port.value.first)];
    access.slot = resource.firstSlot + (access.previous ? resource.versions + 1 : access.version);
    accesses.push_back(access);
  }
}

void makeAccesses(Binding& b, std::vector<Access>& accesses) {
  size_t most = 0;
  for (const Port& port : b.ports) most += port.spec->members.size();
  accesses.reserve(most);  // the passes point into it
  for (uint32_t p = 0; p < b.graph.passes.size(); ++p) {
    const size_t first = accesses.size();
    for (const Port& port : b.portsOf(p))
      if (port.value.first != kNone) addAccesses(b, port, accesses);
    b.graph.passes[p].accesses = std::span(accesses).subspan(first);
  }
}

void bindOutputs(Binding& b) {
  for (const WireDescription& wire : b.description.outputs) {
    Port port;
    port.wire = &wire;
    connectWire(b, port);
    const PortValue& value = port.value;
    const bool bundle = value.origin && value.member == kNone && !value.origin->bundle.empty();
    for (uint32_t m = 0; value.first != kNone && m < value.count; ++m) {
      const uint32_t r = value.first + m;
      BoundResource& resource = b.graph.resources[r];
      const uint32_t version = versionSeen(b, port, r);
      if (version != resource.versions)
        reportWire(b, port, fmt::format("`{}` is updated in place later in the frame", wire.text()),
                   "wire the output to the last pass that updates it");
      resource.output = true;
      resource.usage |= static_cast<uint32_t>(Usage::TransferRead);
      b.graph.outputs.push_back(
          {bundle ? wire.target() + "." + value.origin->members[m].name : wire.target(), r, version});
    }
  }
}

// A history edge reads what the resource held at the end of the last frame.
void markHistory(Binding& b) {
  for (const Port& port : b.ports) {
    if (!port.previous() || port.value.first == kNone) continue;
    for (uint32_t m = 0; m < port.spec->members.size(); ++m) {
      const uint32_t r = resourceOf(b, port, m);
      if (r == kNone) continue;
      BoundResource& resource = b.graph.resources[r];
      resource.history = true;
      if (resource.external)
        reportWire(b, port, "an input of the graph has no history", "wire it without `@previous`");
      else if (resource.lifetime != Lifetime::Transient)
        reportWire(
            b, port,
            fmt::format("`{}` is kept and updated in place, so last frame's value is gone", resource.name),
            "wire it without `@previous`, or make its pass declare it without keep()");
      else if (port.source != kNone && versionSeen(b, port, r) != resource.versions)
        reportWire(b, port, fmt::format("`{}` is updated in place later in the frame", port.wire->text()),
                   "`@previous` holds the last update: wire the pass that makes it");
    }
  }
}

uint64_t graphHash(const BoundGraph& graph) {
  Hasher h;
  for (const BoundPass& pass : graph.passes) {
    h.add(pass.name);
    h.add(pass.declaration->type);
    h.add(pass.view);
    for (const Value& value : pass.parameters.values()) h.add(value);
    for (const Access& a : pass.accesses)
      h.add(uint64_t(a.resource) << 32 | uint64_t(a.port) << 16 | a.member,
            uint64_t(a.version) << 32 | uint64_t(a.usage) << 3 | uint64_t(a.previous) << 2 |
                uint64_t(a.reads) << 1 | uint64_t(a.writes));
  }
  for (const BoundResource& r : graph.resources) {
    const ResourceDesc& d = r.desc;
    h.add(uint64_t(d.width) << 32 | d.height, uint64_t(d.depth) << 32 | d.layers);
    h.add(uint64_t(d.format) << 32 | uint64_t(d.mips) << 8 | uint64_t(d.kind) << 7 | uint64_t(d.volume) << 6 |
              uint64_t(d.array) << 5 | uint64_t(r.external) << 4 | uint64_t(r.history) << 3 |
              uint64_t(r.output) << 2 | uint64_t(r.lifetime),
          d.count * 31 + d.stride);
  }
  for (const BoundOutput& o : graph.outputs) h.add(o.name), h.add(o.resource);
  for (const std::string& view : graph.views) h.add(view);
  for (const Value& value : graph.view.values()) h.add(value);
  return h.value();
}

}  // namespace
}  // namespace detail

BoundGraph bind(const Description& description, const Environment& environment, Diagnostics& diagnostics) {
  BoundGraph graph;
  graph.name = description.name;
  graph.description = description.description;
  graph.raysOnHost = environment.raysOnHost;
  const auto values = std::make_shared<std::vector<Value>>();  // complete before anyone reads them
  const auto accesses = std::make_shared<std::vector<Access>>();
  graph.values = values;
  graph.accesses = accesses;
  detail::Binding b{description, environment, diagnostics, graph};
  detail::openFirstView(b);
  detail::declarePasses(b, *values);
  detail::assignWires(b);
  detail::makeExternals(b);
  detail::makeResources(b);
  detail::followValues(b);
  detail::checkTypes(b);
  detail::openUnusedInputs(b);
  const std::vector<uint32_t> order = detail::orderPasses(b);
  detail::makeVersions(b, order);
  detail::evaluateSizes(b, order);
  detail::makeAccesses(b, *accesses);
  detail::bindOutputs(b);
  detail::markHistory(b);
  if (order.size() == graph.passes.size()) detail::checkInPlace(b);
  diagnostics.throwIfErrors();
  detail::chooseLayouts(graph, *accesses);
  graph.hash = detail::graphHash(graph);
  return graph;
}

}  // namespace fovea::graph
