// Bind, wires: assigns to every wired port the resources that it stands for, and compares types.
#include <fmt/format.h>

#include <algorithm>

#include "framework/gpu/format.h"
#include "framework/graph/compile/binding.h"

namespace fovea::graph::detail {

std::string wirePath(const Binding& b, const Port& port) {
  if (port.wire->nearest) return port.wire->nearestPath;
  if (!port.spec) return json::joinPath("outputs", port.wire->target());
  return passPath(b, port.pass, json::joinPath("inputs", port.wire->target()));
}

void reportWire(Binding& b, const Port& port, std::string message, std::string remedy) {
  report(b, port.wire->where(), wirePath(b, port), std::move(message), std::move(remedy));
}

uint32_t versionSeen(const Binding& b, const Port& port, uint32_t resource) {
  if (port.source == kNone) return 0;  // external, before any update
  const Port& source = b.ports[port.source];
  if (source.firstVersion == kNone) return 0;  // after a mistake
  return b.versions[source.firstVersion + (resource - source.value.first)];
}

uint32_t resourceOf(const Binding& b, const Port& port, uint32_t m) {
  const PortValue& value = port.value;
  if (value.count == 1 && port.spec->bundle.empty()) return value.first;
  if (value.origin == port.spec) return value.first + m;
  if (value.first == kNone) return kNone;
  const std::string& wanted = port.spec->members[m].name;
  if (value.origin) {
    const std::vector<MemberSpec>& members = value.origin->members;
    for (uint32_t k = 0; k < members.size(); ++k)
      if (members[k].name == wanted) return value.first + k;
  } else {
    const std::vector<std::string>& members = b.description.externals[value.external].members;
    for (uint32_t k = 0; k < members.size(); ++k)
      if (members[k] == wanted) return value.first + k;
  }
  return kNone;
}

uint32_t resourceNamed(Binding& b, uint32_t pass, std::string_view name) {
  for (const Port& port : b.portsOf(pass))
    for (uint32_t m = 0; m < port.spec->members.size(); ++m)
      if (memberPath(*port.spec, port.spec->members[m]) == name) return resourceOf(b, port, m);
  return kNone;
}

namespace {

// ---- Descriptions for messages -----------------------------------------------------------------------

// "an image of rgba16f", "a buffer of Light (64 bytes each)"; of a ResourceSpec or a ResourceDesc.
template <class Resource>
std::string describeResource(const Resource& r) {
  if (r.kind == ResourceKind::Buffer)
    return r.element.empty() ? fmt::format("a buffer of elements of {} bytes", r.stride)
                             : fmt::format("a buffer of {} ({} bytes each)", r.element, r.stride);
  const char* shape = r.volume ? "a 3D image" : r.array ? "an image array" : "an image";
  if (r.format == VK_FORMAT_UNDEFINED) return fmt::format("{} of floating-point texels", shape);
  return fmt::format("{} of {}", shape, gpu::formatInfo(r.format).name);
}

// The bundle type of a whole value; "" for plain values and for members.
std::string_view bundleOf(const Binding& b, const PortValue& value) {
  if (value.member != kNone) return {};
  if (value.origin) return value.origin->bundle;
  return value.external == kNone ? std::string_view() : b.description.externals[value.external].bundle;
}

std::string describeValue(const Binding& b, const PortValue& value) {
  const std::string_view bundle = bundleOf(b, value);
  if (!bundle.empty()) return fmt::format("a bundle `{}`", bundle);
  if (value.origin)
    return describeResource(value.origin->members[value.member == kNone ? 0 : value.member].resource);
  return describeResource(b.graph.resources[value.first].desc);
}

}  // namespace

std::string describeWanted(const PortSpec& spec) {
  return spec.bundle.empty() ? describeResource(spec.members[0].resource)
                             : fmt::format("a bundle `{}`", spec.bundle);
}

namespace {

// ---- From names to ports -----------------------------------------------------------------------------

bool producing(const PortSpec& spec) {
  return spec.direction == Direction::Output || spec.direction == Direction::InOut;
}

uint32_t onlyOutput(const std::vector<PortSpec>& specs) {
  uint32_t only = kNone, offered = 0, k = 0;
  for (const PortSpec& spec : specs) {
    if (producing(spec)) {
      only = k;
      ++offered;
    }
    ++k;
  }
  return offered == 1 ? only : kNone;
}

uint32_t outputNamed(const std::vector<PortSpec>& specs, std::string_view name) {
  for (uint32_t k = 0; k < specs.size(); ++k)
    if (producing(specs[k]) && specs[k].name == name) return k;
  return kNone;
}

// Finds the port that the wire names, and the member of it; false if there is none.
bool selectPort(const std::vector<PortSpec>& specs, const WireDescription& wire, uint32_t& port,
                uint32_t& member) {
  std::string_view memberName = wire.member;
  port = wire.port.empty() ? onlyOutput(specs) : outputNamed(specs, wire.port);
  if (port == kNone && wire.member.empty()) {
    port = onlyOutput(specs);  // "surface.position": a member of the only output
    memberName = wire.port;
  }
  member = kNone;
  if (port == kNone || memberName.empty()) return port != kNone;
  for (uint32_t m = 0; m < specs[port].members.size(); ++m)
    if (specs[port].members[m].name == memberName) member = m;
  return member != kNone;
}

void reportNoOutput(Binding& b, const Port& port) {
  const WireDescription& wire = *port.wire;
  const std::string& name = b.description.passes[wire.pass].name;
  std::vector<std::string> names;
  for (const PortSpec& spec : b.graph.passes[wire.pass].declaration->ports) {
    if (!producing(spec)) continue;
    names.push_back(name + "." + spec.name);
    if (wire.member.empty() && spec.bundle.empty()) continue;
    for (const MemberSpec& m : spec.members)
      if (!m.name.empty()) names.push_back(name + "." + spec.name + "." + m.name);
  }
  if (blameType(b, wire.pass, wire.where(), fmt::format("it has no output `{}`", wire.port))) return;
  std::vector<std::string> spellings = names;
  if (onlyOutput(b.graph.passes[wire.pass].declaration->ports) != kNone)  // whose name may be left out
    for (const std::string& known : names)
      if (const size_t dot = known.find('.', name.size() + 1); dot != std::string::npos)
        spellings.push_back(name + known.substr(dot));
  const std::string nearest = nearestName(wire.text(), spellings);
  reportWire(b, port,
             wire.port.empty() ? fmt::format("`{}` has {} outputs: name one", wire.text(), names.size())
                               : fmt::format("no output `{}`", wire.text()),
             !nearest.empty() && !wire.port.empty() ? fmt::format("did you mean `{}`?", nearest)
             : names.empty()                        ? fmt::format("`{}` has no outputs", name)
                                                    : fmt::format("there is: {}", fmt::join(names, ", ")));
}

// ---- Values ------------------------------------------------------------------------------------------

// Takes the value of the port's source, or the member of it that the wire names.
void takeValue(Binding& b, Port& port) {
  const uint32_t member = port.value.member;
  port.state = Port::State::Known;
  port.value = port.source == kNone ? PortValue{} : b.ports[port.source].value;
  PortValue& value = port.value;
  if (value.first == kNone || member == kNone) return;
  // The member's name was looked up in the source's declaration; an in-out port there may list fewer members.
  const std::string& name = b.ports[port.source].spec->members[member].name;
  value.member = member;
  if (value.origin)
    for (uint32_t m = 0; m < value.origin->members.size(); ++m)
      if (value.origin->members[m].name == name) value.member = m;
  value.first += value.member;
  value.count = 1;
}

void connectExternal(Binding& b, Port& port) {
  const WireDescription& wire = *port.wire;
  const ExternalDescription& external = b.description.externals[*wire.external];
  port.state = Port::State::Known;
  port.value = {b.firstOfExternal[*wire.external], static_cast<uint32_t>(external.members.size()), nullptr,
                kNone, *wire.external};
  if (wire.member.empty()) return;
  const auto at = std::find(external.members.begin(), external.members.end(), wire.member);
  port.value.member = static_cast<uint32_t>(at - external.members.begin());
  port.value.first += port.value.member;
  port.value.count = 1;
  if (at != external.members.end()) return;
  port.value = {};
  reportWire(b, port, fmt::format("the input `{}` has no member `{}`", external.name, wire.member));
}

// An in-out port offers what it is wired to: walks up to a port whose value is known, then down again.
void followValue(Binding& b, uint32_t port) {
  std::vector<uint32_t> chain;
  uint32_t at = port;
  while (at != kNone && b.ports[at].state == Port::State::Unknown) {
    b.ports[at].state = Port::State::BeingFollowed;
    chain.push_back(at);
    at = b.ports[at].source;
  }
  if (at != kNone && b.ports[at].state == Port::State::BeingFollowed && b.ports[at].wire)
    reportWire(b, b.ports[at], "in-place updates wired in a circle: no pass makes the first value",
               "wire one of them to an output");
  for (size_t i = chain.size(); i-- > 0;) takeValue(b, b.ports[chain[i]]);
}

// ---- Types -------------------------------------------------------------------------------------------

// Sizes are evaluated later, so only declarations are compared.
bool fits(const Binding& b, const MemberSpec& wanted, uint32_t resource) {
  const ResourceSpec& want = wanted.resource;
  const auto compare = [&](const auto& have) {
    if (have.kind != want.kind) return false;
    if (have.kind == ResourceKind::Buffer) return have.element == want.element && have.stride == want.stride;
    if (have.volume != want.volume || have.array != want.array) return false;
    if (want.format != VK_FORMAT_UNDEFINED) return have.format == want.format;
    const gpu::FormatInfo* format = gpu::findFormat(have.format);
    return !format || !format->integer();
  };
  const MemberSpec* made = b.origins[resource].spec;
  return made ? compare(made->resource) : compare(b.graph.resources[resource].desc);
}

// Marks the passes that need a pass in the same frame, itself included.
void markDependents(const Binding& b, uint32_t pass, std::vector<uint8_t>& marks) {
  marks[pass] = 1;
  for (bool more = true; more;) {
    more = false;
    for (const Port& port : b.ports) {
      if (port.source == kNone || port.previous() || marks[port.pass] || !marks[b.ports[port.source].pass])
        continue;
      marks[port.pass] = 1;
      more = true;
    }
  }
}

}  // namespace

std::string missingRemedy(const Binding& b, const Port& missing) {
  const PortSpec& spec = *missing.spec;
  std::vector<uint8_t> wouldWait(b.graph.passes.size(), 0);  // for this pass, so that none could come first
  markDependents(b, missing.pass, wouldWait);
  std::vector<std::string> names;
  for (const Port& port : b.ports) {
    const PortSpec& other = *port.spec;
    if (other.direction != Direction::Output || other.bundle != spec.bundle || names.size() >= 6) continue;
    if (wouldWait[port.pass]) continue;
    if (spec.bundle.empty() && !fits(b, spec.members[0], port.value.first)) continue;
    names.push_back(fmt::format("{}.{}", b.graph.passes[port.pass].name, other.name));
  }
  if (names.empty()) return "no other pass of the graph makes one";
  return fmt::format("these would fit: {}", fmt::join(names, ", "));
}

namespace {

void noteUnwired(Binding& b, const Port& port) {
  const PassDescription& pass = b.description.passes[port.pass];
  const std::string path = passPath(b, port.pass, "inputs." + port.spec->name);
  if (Removal* removal = findRemoval(b.removals, pass.document, path))
    removal->neededAt.push_back(path);
  else
    b.unwired[port.pass].push_back(&port);
}

// "" if the description of the value as a whole is enough.
std::string describeMisfit(const Binding& b, const Port& port, uint32_t m) {
  const MemberSpec& wanted = port.spec->members[m];
  const uint32_t resource = resourceOf(b, port, m);
  if (resource == kNone) return fmt::format(": it lacks the member `{}`", wanted.name);
  if (wanted.name.empty()) return {};
  const MemberSpec* made = b.origins[resource].spec;
  return fmt::format(
      ": its member `{}` is {}", wanted.name,
      made ? describeResource(made->resource) : describeResource(b.graph.resources[resource].desc));
}

// `m` is the first member that does not fit, or kNone if the value as a whole does not.
void reportMisfit(Binding& b, const Port& port, uint32_t m) {
  const PortSpec& spec = *port.spec;
  const std::string what =
      fmt::format("`{}` wants {}, but `{}` is {}{}", spec.name, describeWanted(spec), port.wire->text(),
                  describeValue(b, port.value), m == kNone ? std::string() : describeMisfit(b, port, m));
  std::string remedy;
  if (!bundleOf(b, port.value).empty() && spec.bundle.empty() && port.value.origin)
    for (const MemberSpec& member : port.value.origin->members) {
      const ResourceSpec &have = member.resource, &want = spec.members[0].resource;
      if (have.kind == want.kind && (have.format == want.format || want.format == VK_FORMAT_UNDEFINED) &&
          remedy.empty())
        remedy = fmt::format("wire a member of it, such as `{}.{}`", port.wire->text(), member.name);
    }
  blameAlong(b, port, what, remedy);
}

void checkPort(Binding& b, Port& port) {
  const PortSpec& spec = *port.spec;
  if (port.previous() && spec.direction == Direction::InOut) {
    reportWire(b, port, fmt::format("`{}` is updated in place, last frame's value cannot be", spec.name),
               "wire it without `@previous`");
    port.value = {};
    return;
  }
  const auto misfit = [&](uint32_t m) {
    reportMisfit(b, port, m);
    port.value = {};  // so that nothing follows from it
  };
  if (bundleOf(b, port.value) != spec.bundle) return misfit(kNone);
  for (uint32_t m = 0; m < spec.members.size(); ++m) {
    const uint32_t resource = resourceOf(b, port, m);
    if (resource == kNone || !fits(b, spec.members[m], resource)) return misfit(m);
  }
}

}  // namespace

// ---- Steps -------------------------------------------------------------------------------------------

void assignWires(Binding& b) {
  for (uint32_t p = 0; p < b.graph.passes.size(); ++p) {
    const PassDescription& from = b.description.passes[p];
    const PassDeclaration* declaration = b.graph.passes[p].declaration;
    if (!declaration) continue;
    const std::span<Port> ports = b.portsOf(p);
    // Inputs are mostly wired in the order of declaration, so the search starts after the last one found.
    size_t next = 0;
    for (uint32_t i = 0; i < from.inputCount; ++i) {
      const WireDescription& wire = b.description.wires[from.firstInput + i];
      const auto named = [&](const Port& port) { return port.spec->name == wire.target(); };
      auto port = std::find_if(ports.begin() + next, ports.end(), named);
      if (port == ports.end()) port = std::find_if(ports.begin(), ports.end(), named);
      if (port != ports.end() && !makes(*port->spec)) {
        port->wire = &wire;
        next = port - ports.begin() + 1;
        continue;
      }
      std::vector<std::string> names;
      for (const PortSpec& spec : declaration->ports)
        if (!makes(spec)) names.push_back(spec.name);
      if (blameType(b, p, wire.written->keyWhere, fmt::format("it has no input `{}`", wire.target())))
        continue;
      const std::string nearest = nearestName(wire.target(), names);
      for (Port& meant : ports) meant.misspelt |= !nearest.empty() && meant.spec->name == nearest;
      report(b, wire.written->keyWhere, passPath(b, p, json::joinPath("inputs", wire.target())),
             port != ports.end()
                 ? fmt::format("`{}` is an output of `{}`, not an input", wire.target(), declaration->type)
                 : fmt::format("`{}` has no input `{}`", declaration->type, wire.target()),
             remedyFor(wire.target(), names));
    }
  }
}

void connectWire(Binding& b, Port& port) {
  const WireDescription& wire = *port.wire;
  if (wire.external && !wire.broken) return connectExternal(b, port);
  port.state = Port::State::Known;  // without a value, if a mistake was or is reported
  const PassDeclaration* declaration = wire.broken ? nullptr : b.graph.passes[wire.pass].declaration;
  if (!declaration) return;
  uint32_t index, member;
  if (!selectPort(declaration->ports, wire, index, member)) return reportNoOutput(b, port);
  port.source = b.firstPort[wire.pass] + index;
  port.value.member = member;
  port.state = Port::State::Unknown;
  if (b.ports[port.source].state == Port::State::Known) takeValue(b, port);  // otherwise when it is followed
}

void followValues(Binding& b) {
  for (Port& port : b.ports)
    if (port.wire) connectWire(b, port);
  for (uint32_t i = 0; i < b.ports.size(); ++i)
    if (b.ports[i].state == Port::State::Unknown) followValue(b, i);
}

void checkTypes(Binding& b) {
  for (Port& port : b.ports) {
    if (makes(*port.spec)) continue;
    if (!port.wire && !port.spec->optional && !port.misspelt) noteUnwired(b, port);
    if (port.value.first != kNone) checkPort(b, port);
  }
}

}  // namespace fovea::graph::detail
