// Bind: turns names into a checked graph of passes and resources.
#include <fmt/format.h>

#include <algorithm>
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
  const PassDescription& pass = b.description.passes[p];
  if (!pass.type) return nullptr;
  const std::string name = fromEnvironment(b, pass.type->string);
  const PassDeclaration* declaration = registry.find(name);
  if (declaration) return declaration;
  if (pass.typeFrom) {
    b.misfits[p] = {};  // what is allowed in its place says enough
    return nullptr;
  }
  const std::string nearest = nearestName(name, registry.types());
  report(b, pass.type->where, passPath(b, p, "type"), fmt::format("no pass type `{}`", name),
         nearest.empty()
             ? std::string(
                   "`fovea passes` lists them; a program of yours has those that it registers, the stock "
                   "ones with fovea::passes::registerAll()")
             : fmt::format("did you mean `{}`?", nearest));
  return nullptr;
}

// Whether a `null` removed something that is needed, which is reported later.
bool isMissing(const Description& description) {
  return std::ranges::any_of(description.removals, [](const Removal& r) { return !r.neededAt.empty(); });
}

void declarePasses(Binding& b, std::vector<Value>& values) {
  const Registry& registry = b.environment.registry ? *b.environment.registry : Registry::global();
  const auto count = static_cast<uint32_t>(b.description.passes.size());
  b.graph.passes.resize(count);
  b.uses.resize(b.description.graphParameters.size());
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
        std::span(b.description.parameters).subspan(from.firstParameter, from.parameterCount), values, p);
    uint16_t index = 0;
    for (const PortSpec& spec : pass.declaration->ports) b.ports.push_back({&spec, p, index++});
    effects |= pass.declaration->sideEffects;
  }
  b.firstPort.push_back(static_cast<uint32_t>(b.ports.size()));
  const bool hasErrors =
      b.diagnostics.hasErrors() || !b.misfits.empty() || !b.wrongValues.empty() || isMissing(b.description);
  if (b.description.outputs.empty() && !effects && !hasErrors)
    b.diagnostics.error(b.description.start, "outputs", "the graph has no outputs, so nothing would run",
                        "add \"outputs\": {\"image\": \"pass.port\"}");
}

// Whether no mistake has been found, of which some are reported only at the end.
bool isSound(const Binding& b) {
  return !b.diagnostics.hasErrors() && b.misfits.empty() && b.wrongValues.empty() && b.unwired.empty() &&
         std::ranges::all_of(b.removals, [](const Removal& r) { return r.neededAt.empty(); });
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
  return bind(description, environment, diagnostics, true);
}

BoundGraph bind(const Description& description, const Environment& environment, Diagnostics& diagnostics,
                bool suggest) {
  BoundGraph graph;
  graph.name = description.name;
  graph.description = description.description;
  graph.raysOnHost = environment.raysOnHost;
  const auto values = std::make_shared<std::vector<Value>>();  // complete before anyone reads them
  const auto accesses = std::make_shared<std::vector<Access>>();
  graph.values = values;
  graph.accesses = accesses;
  detail::Binding b{description, environment, diagnostics, graph, suggest};
  b.removals = description.removals;
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
  if (detail::isSound(b)) detail::checkRequirements(b);
  detail::reportWrongValues(b);
  detail::reportUnusedOverrides(b);
  detail::reportUnwired(b);
  detail::reportRemovals(b);
  detail::reportMisfits(b);
  diagnostics.throwIfErrors();
  detail::chooseLayouts(graph, *accesses);
  graph.hash = detail::graphHash(graph);
  return graph;
}

}  // namespace fovea::graph
