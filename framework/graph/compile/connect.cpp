// Bind, wires: assigns to every wired port the resources that it stands for, and compares types.
#include <fmt/format.h>

#include <algorithm>

#include "framework/base/same_text.h"
#include "framework/gpu/format.h"
#include "framework/graph/compile/binder.h"

namespace fovea::graph::detail {

namespace {

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
  uint32_t k = 0;
  for (const PortSpec& spec : specs) {
    if (producing(spec) && sameText(spec.name, name)) return k;
    ++k;
  }
  return kNone;
}

}  // namespace

std::string describeResource(ResourceKind kind, VkFormat format, bool volume, bool array,
                             std::string_view element, uint32_t stride) {
  if (kind == ResourceKind::Buffer) return fmt::format("a buffer of {} ({} bytes each)", element, stride);
  const char* shape = volume ? "a 3D image" : array ? "an image array" : "an image";
  if (format == VK_FORMAT_UNDEFINED) return fmt::format("{} of floating-point texels", shape);
  return fmt::format("{} of {}", shape, gpu::formatInfo(format).name);
}

std::string Binder::describeValue(const PortValue& value) const {
  if (value.origin && !value.origin->bundle.empty() && value.member == kNone)
    return fmt::format("a bundle `{}`", value.origin->bundle);
  if (value.external != kNone && value.member == kNone) {
    const std::string_view bundle = text(description_.externals[value.external].bundle);
    if (!bundle.empty()) return fmt::format("a bundle `{}`", bundle);
  }
  if (value.origin) {
    const ResourceSpec& r = value.origin->members[value.member == kNone ? 0 : value.member].resource;
    return describeResource(r.kind, r.format, r.volume, r.array, r.element, r.stride);
  }
  const ResourceDesc& d = graph_.resources[value.first].desc;
  return describeResource(d.kind, d.format, d.volume, d.array, d.element, d.stride);
}

std::string Binder::describeWanted(const PortSpec& spec) const {
  if (!spec.bundle.empty()) return fmt::format("a bundle `{}`", spec.bundle);
  const ResourceSpec& r = spec.members[0].resource;
  return describeResource(r.kind, r.format, r.volume, r.array, r.element, r.stride);
}

std::string Binder::wirePath(const PortState& port) const {
  const WireDescription& wire = description_.wires[port.wire];
  return passPath(port.pass, json::joinPath("inputs", wire.target));
}

// ---- From names to ports -----------------------------------------------------------------------------

void Binder::assignWires() {
  for (uint32_t p = 0; p < graph_.passes.size(); ++p) {
    const PassDescription& from = description_.passes[p];
    const PassDeclaration* declaration = graph_.passes[p].declaration;
    if (!declaration) continue;
    const std::vector<PortSpec>& specs = declaration->ports;
    const size_t count = specs.size();
    // Inputs are mostly wired in the order of declaration, so the search starts where the last one was found.
    size_t guess = 0;
    for (uint32_t i = 0; i < from.inputCount; ++i) {
      const WireDescription& wire = description_.wires[from.firstInput + i];
      const std::string_view name = wire.target;
      size_t k = 0;
      for (; k < count; ++k, ++guess) {
        if (guess >= count) guess = 0;
        if (sameText(specs[guess].name, name)) break;
      }
      if (k < count && !makes(specs[guess])) {
        portsOf(p)[guess].wire = from.firstInput + i;
        ++guess;
        continue;
      }
      std::vector<std::string> names;
      for (const PortSpec& spec : specs)
        if (spec.direction == Direction::Input || spec.direction == Direction::InOut)
          names.push_back(spec.name);
      const std::string nearest = nearestName(name, names);
      error(wire.keyPlace, passPath(p, json::joinPath("inputs", name)),
            k < count ? fmt::format("`{}` is an output of `{}`, not an input", name, declaration->type)
                      : fmt::format("`{}` has no input `{}`", declaration->type, name),
            !nearest.empty() ? fmt::format("did you mean `{}`?", nearest)
            : names.empty()  ? std::string("it has none")
                             : fmt::format("it has: {}", fmt::join(names, ", ")));
    }
  }
}

// Finds the port of `pass` that the wire names; false if there is none.
inline bool Binder::selectPort(const WireDescription& wire, uint32_t pass, uint32_t& port, uint32_t& member) {
  const std::vector<PortSpec>& specs = graph_.passes[pass].declaration->ports;
  Symbol memberName = wire.member;
  port = wire.port == kNone ? onlyOutput(specs) : outputNamed(specs, text(wire.port));
  if (port == kNone && wire.port != kNone && wire.member == kNone) {
    port = onlyOutput(specs);  // "surface.position": a member of the only output
    memberName = wire.port;
  }
  member = kNone;
  return port != kNone && (memberName == kNone || selectMember(specs[port], memberName, member));
}

bool Binder::selectMember(const PortSpec& spec, Symbol name, uint32_t& member) const {
  for (uint32_t m = 0; m < spec.members.size(); ++m)
    if (spec.members[m].name == text(name)) member = m;
  return member != kNone;
}

// Takes the value of the port's source, or the member of it that the wire names.
inline void Binder::takeValue(PortState& port) {
  const uint32_t member = port.value.member;
  port.state = 2;
  port.value = port.source == kNone ? PortValue{} : ports_[port.source].value;
  if (port.value.first != kNone && member != kNone) takeMember(port, member);
}

void Binder::connectWire(PortState& port, const WireDescription& wire) {
  port.previous = wire.previous;
  if (wire.external != kNone) return connectExternal(port, wire);
  const uint32_t pass = passBySymbol_[wire.pass];
  if (pass == kNone || !graph_.passes[pass].declaration) {
    port.state = 2;  // the unknown pass or its unknown type has been reported
    return;
  }
  uint32_t index, member;
  if (!selectPort(wire, pass, index, member)) return reportNoOutput(port, wire, pass);
  port.source = firstPort_[pass] + index;
  port.value.member = member;
  inOrder_ &= port.previous || pass < port.pass;
  if (ports_[port.source].state == 2) takeValue(port);  // otherwise when its value is followed
}

void Binder::connectExternal(PortState& port, const WireDescription& wire) {
  const ExternalDescription& external = description_.externals[wire.external];
  port.value = {externalFirst_[wire.external], static_cast<uint32_t>(external.members.size()), nullptr, kNone,
                wire.external};
  port.state = 2;
  if (wire.member == kNone) return;
  const auto at = std::find(external.members.begin(), external.members.end(), wire.member);
  port.value.member = static_cast<uint32_t>(at - external.members.begin());
  port.value.first += port.value.member;
  port.value.count = 1;
  if (at != external.members.end()) return;
  port.value = {};
  error(wire.place, connectedPath(port, wire),
        fmt::format("the input `{}` has no member `{}`", text(external.name), text(wire.member)));
}

void Binder::reportNoOutput(PortState& port, const WireDescription& wire, uint32_t pass) {
  port.state = 2;
  std::vector<std::string> names;
  const std::string name(text(description_.passes[pass].name));
  for (const PortSpec& spec : graph_.passes[pass].declaration->ports) {
    if (!producing(spec)) continue;
    names.push_back(name + "." + spec.name);
    if (wire.member == kNone && spec.bundle.empty()) continue;
    for (const MemberSpec& m : spec.members)
      if (!m.name.empty()) names.push_back(name + "." + spec.name + "." + m.name);
  }
  const std::string nearest = nearestName(wire.written, names);
  error(wire.place, connectedPath(port, wire),
        wire.port == kNone ? fmt::format("`{}` has {} outputs: name one", wire.written, names.size())
                           : fmt::format("no output `{}`", wire.written),
        !nearest.empty() && wire.port != kNone ? fmt::format("did you mean `{}`?", nearest)
        : names.empty()                        ? fmt::format("`{}` has no outputs", name)
                                               : fmt::format("there is: {}", fmt::join(names, ", ")));
}

// The place where a wire of a pass or of the graph's outputs is written.
std::string Binder::connectedPath(const PortState& port, const WireDescription& wire) const {
  return port.pass == kNone ? json::joinPath("outputs", wire.target) : wirePath(port);
}

// ---- Values ------------------------------------------------------------------------------------------

void Binder::followValues() {
  for (PortState& port : ports_)
    if (port.wire != kNone) connectWire(port, description_.wires[port.wire]);
  if (!inPlace_) return;  // all sources were outputs
  for (uint32_t i = 0; i < ports_.size(); ++i)
    if (ports_[i].state == 0) followValue(i);
}

// An in-out port offers what it is wired to: walks up to a port whose value is known, then down again.
void Binder::followValue(uint32_t port) {
  ScratchVector<uint32_t>& chain = chain_;
  chain.clear();
  uint32_t at = port;
  while (at != kNone && ports_[at].state == 0) {
    ports_[at].state = 1;
    chain.push_back(at);
    at = ports_[at].source;
  }
  if (at != kNone && ports_[at].state == 1 && ports_[at].wire != kNone) {
    error(description_.wires[ports_[at].wire].place, wirePath(ports_[at]),
          "in-place updates wired in a circle: no pass makes the first value",
          "wire one of them to an output");
  }
  for (size_t i = chain.size(); i-- > 0;) takeValue(ports_[chain[i]]);
}

void Binder::takeMember(PortState& port, uint32_t member) {
  PortValue& value = port.value;
  // The member's name was looked up in the source's declaration; an in-out port there may list fewer members.
  const std::string& name = ports_[port.source].spec->members[member].name;
  value.member = member;
  if (value.origin)
    for (uint32_t m = 0; m < value.origin->members.size(); ++m)
      if (value.origin->members[m].name == name) value.member = m;
  value.first += value.member;
  value.count = 1;
}

uint32_t Binder::resourceNamed(const PortValue& value, const std::string& member) const {
  if (value.origin) {
    const std::vector<MemberSpec>& members = value.origin->members;
    for (uint32_t k = 0; k < members.size(); ++k)
      if (members[k].name == member) return value.first + k;
  } else {
    const std::vector<Symbol>& members = description_.externals[value.external].members;
    for (uint32_t k = 0; k < members.size(); ++k)
      if (text(members[k]) == member) return value.first + k;
  }
  return kNone;
}

// ---- Types -------------------------------------------------------------------------------------------

void Binder::checkTypes() {
  for (PortState& port : ports_) {
    const PortSpec& spec = *port.spec;
    if (makes(spec)) continue;
    if (port.wire == kNone && !spec.optional) reportUnwired(port, spec);
    if (port.value.first != kNone) checkPort(port, spec);
  }
}

void Binder::reportUnwired(const PortState& port, const PortSpec& spec) {
  const PassDescription& pass = description_.passes[port.pass];
  // A wire that was given but could not be resolved has been reported already.
  if (diagnostics_.hasErrors()) {
    const std::string path = passPath(port.pass, "inputs." + spec.name);
    const bool said = std::any_of(diagnostics_.list().begin(), diagnostics_.list().end(),
                                  [&](const Diagnostic& d) { return d.path == path; });
    if (said || pass.type == kNone) return;
  }
  error(pass.place, passPath(port.pass, "inputs"),
        fmt::format("`{}`: the input `{}` ({}) is not wired", graph_.passes[port.pass].name, spec.name,
                    describeWanted(spec)),
        missingRemedy(spec));
}

// The bundle type of a whole value; "" for plain values and for members.
std::string_view Binder::bundleOf(const PortValue& value) const {
  if (value.member != kNone) return {};
  if (value.origin) return value.origin->bundle;
  return value.external == kNone ? std::string_view() : text(description_.externals[value.external].bundle);
}

void Binder::checkPort(PortState& port, const PortSpec& spec) {
  if (port.previous && spec.direction == Direction::InOut) {
    error(description_.wires[port.wire].place, wirePath(port),
          fmt::format("`{}` is updated in place, last frame's value cannot be", spec.name),
          "wire it without `@previous`");
    port.value = {};
    return;
  }
  if (!sameText(bundleOf(port.value), spec.bundle)) return reportMisfit(port, spec, kNone);
  uint32_t m = 0;
  for (const MemberSpec& member : spec.members) {
    const uint32_t resource = resourceOf(port, m);
    if (resource == kNone || !fits(member, resource)) return reportMisfit(port, spec, m);
    ++m;
  }
}

// `m` is the first member that does not fit, or kNone if the value as a whole does not.
void Binder::reportMisfit(const PortState& port, const PortSpec& spec, uint32_t m) {
  const std::string why = m == kNone ? std::string() : describeMisfit(port, spec.members[m], m);
  const WireDescription& wire = description_.wires[port.wire];
  std::string remedy;
  if (!bundleOf(port.value).empty() && spec.bundle.empty() && port.value.origin)
    for (const MemberSpec& member : port.value.origin->members) {
      const ResourceSpec &have = member.resource, &want = spec.members[0].resource;
      if (have.kind == want.kind && (have.format == want.format || want.format == VK_FORMAT_UNDEFINED) &&
          remedy.empty())
        remedy = fmt::format("wire a member of it, such as `{}.{}`", wire.written, member.name);
    }
  error(wire.place, wirePath(port),
        fmt::format("`{}` wants {}, but `{}` is {}{}", spec.name, describeWanted(spec), wire.written,
                    describeValue(port.value), why.empty() ? why : ": " + why),
        remedy);
}

// Sizes are evaluated later, so only declarations are compared.
bool Binder::fits(const MemberSpec& wanted, uint32_t resource) const {
  const ResourceSpec& want = wanted.resource;
  const auto compare = [&](const auto& have) {
    if (have.kind != want.kind) return false;
    if (have.kind == ResourceKind::Buffer) return have.element == want.element && have.stride == want.stride;
    if (have.volume != want.volume || have.array != want.array) return false;
    if (want.format != VK_FORMAT_UNDEFINED) return have.format == want.format;
    const gpu::FormatInfo* format = gpu::findFormat(have.format);
    return !format || !format->integer();
  };
  const MemberSpec* made = resourceSpec_[resource];
  return made ? compare(made->resource) : compare(graph_.resources[resource].desc);
}

// "" if the description of the value as a whole is enough.
std::string Binder::describeMisfit(const PortState& port, const MemberSpec& wanted, uint32_t m) const {
  const uint32_t resource = resourceOf(port, m);
  if (resource == kNone) return fmt::format("it lacks the member `{}`", wanted.name);
  if (wanted.name.empty()) return {};
  const auto describe = [&](const auto& have) {
    return fmt::format(
        "its member `{}` is {}", wanted.name,
        describeResource(have.kind, have.format, have.volume, have.array, have.element, have.stride));
  };
  const MemberSpec* made = resourceSpec_[resource];
  return made ? describe(made->resource) : describe(graph_.resources[resource].desc);
}

std::string Binder::missingRemedy(const PortSpec& spec) const {
  std::vector<std::string> names;
  const MemberSpec& wanted = spec.members[0];
  for (const PortState& port : ports_) {
    const PortSpec& other = *port.spec;
    if (other.direction != Direction::Output || other.bundle != spec.bundle || names.size() >= 6) continue;
    if (spec.bundle.empty() && !fits(wanted, port.value.first)) continue;
    names.push_back(fmt::format("{}.{}", graph_.passes[port.pass].name, other.name));
  }
  if (names.empty()) return "no pass of the graph makes one";
  return fmt::format("these would fit: {}", fmt::join(names, ", "));
}

}  // namespace fovea::graph::detail
