// Bind: turns names into a checked graph of passes and resources.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "framework/base/hash.h"
#include "framework/base/same_text.h"
#include "framework/gpu/format.h"
#include "framework/graph/compile/binder.h"

namespace fovea::graph {

BoundGraph bind(const Description& description, const Environment& environment, Diagnostics& diagnostics) {
  BoundGraph graph;
  detail::Binder(description, environment, diagnostics, graph).run();
  return graph;
}

namespace detail {

Binder::Binder(const Description& description, const Environment& environment, Diagnostics& diagnostics,
               BoundGraph& graph)
    : description_(description),
      environment_(environment),
      diagnostics_(diagnostics),
      registry_(environment.registry ? *environment.registry : Registry::global()),
      graph_(graph) {}

void Binder::run() {
  graph_.name = description_.name;
  graph_.description = description_.description;
  graph_.values = values_;
  openViews();
  declare();
  assignWires();
  makeExternals();
  makeResources();
  followValues();
  checkTypes();
  orderPasses();
  makeVersions();
  evaluateSizes();
  makeAccesses();
  bindOutputs();
  if (history_) markHistory();
  if (inPlace_) checkInPlace();
  diagnostics_.throwIfErrors();
  chooseLayouts();
  graph_.hash = hash();
}

void Binder::error(const Place& place, std::string path, std::string message, std::string remedy) {
  diagnostics_.error(description_.location(place), std::move(path), std::move(message), std::move(remedy));
}

std::string Binder::passPath(uint32_t pass, std::string_view rest) const {
  const std::string path = json::joinPath("passes", description_.localName(description_.passes[pass]));
  return rest.empty() ? path : json::joinPath(path, rest);
}

// ---- Passes and parameters ---------------------------------------------------------------------------

void Binder::openViews() {
  if (environment_.views.empty()) {
    graph_.views.push_back("main");
    viewExtents_.push_back({1, 1});
  } else {
    graph_.views.push_back(environment_.views[0].first);
    viewExtents_.push_back(environment_.views[0].second);
  }
}

void Binder::declare() {
  const size_t count = description_.passes.size();
  graph_.passes.reserve(count);
  values_->reserve(description_.parameters.size() + count);  // estimate: one default per pass
  firstPort_ = scratch_.array<uint32_t>(count + 1);
  ports_.reserve(description_.wires.size() + 2 * count);  // estimate: all inputs wired, two outputs each
  passBySymbol_ = scratch_.array(description_.symbols.size(), kNone);
  const auto types = scratch_.array<const PassDeclaration*>(description_.symbols.size());
  for (uint32_t p = 0; p < count; ++p) {
    const PassDescription& from = description_.passes[p];
    BoundPass& pass = graph_.passes.emplace_back(text(from.name));
    passBySymbol_[from.name] = p;
    firstPort_[p] = static_cast<uint32_t>(ports_.size());
    if (from.type == kNone) continue;
    const PassDeclaration*& type = types[from.type];
    if (!type) type = registry_.find(text(from.type));
    if (!type) {
      const std::string nearest = nearestName(text(from.type), registry_.types());
      error(from.typePlace, passPath(p, "type"), fmt::format("no pass type `{}`", text(from.type)),
            nearest.empty() ? std::string("`fovea passes` lists them")
                            : fmt::format("did you mean `{}`?", nearest));
      continue;
    }
    pass.declaration = type;
    if (from.view != kNone) bindView(pass, from);
    bindParameters(pass, from);
    uint16_t index = 0;
    for (const PortSpec& spec : type->ports) {
      ports_.emplace_back(&spec, p, index++);
      if (makes(spec)) resourceCount_ += spec.members.size();
      inPlace_ |= spec.direction == Direction::InOut;
    }
  }
  firstPort_[count] = static_cast<uint32_t>(ports_.size());
  if (description_.outputs.empty() && !diagnostics_.hasErrors()) {
    const bool effects = std::any_of(graph_.passes.begin(), graph_.passes.end(), [](const BoundPass& p) {
      return p.declaration && p.declaration->sideEffects;
    });
    if (!effects)
      diagnostics_.error({description_.files.empty() ? description_.name : description_.files[0], 1, 1},
                         "outputs", "the graph has no outputs, so nothing would run",
                         "add \"outputs\": {\"image\": \"pass.port\"}");
  }
}

void Binder::bindView(BoundPass& pass, const PassDescription& from) {
  const std::string_view name = text(from.view);
  const auto at = std::find(graph_.views.begin(), graph_.views.end(), name);
  pass.view = static_cast<uint32_t>(at - graph_.views.begin());
  if (at == graph_.views.end()) {
    const auto known = std::find_if(environment_.views.begin(), environment_.views.end(),
                                    [&](const auto& view) { return view.first == name; });
    if (known == environment_.views.end()) {
      std::vector<std::string> names;
      for (const auto& [view, extent] : environment_.views) names.push_back(view);
      if (names.empty()) names.push_back("main");
      pass.view = 0;
      const uint32_t p = static_cast<uint32_t>(&from - description_.passes.data());
      error(from.viewPlace, passPath(p, "view"), fmt::format("no view `{}`", name),
            fmt::format("there is: {}", fmt::join(names, ", ")));
      return;
    }
    graph_.views.emplace_back(name);
    viewExtents_.push_back(known->second);
  }
  if (!from.ownView || pass.declaration->usesView) return;
  for (const PortSpec& port : pass.declaration->ports)
    for (const MemberSpec& member : port.members)
      for (const SizeExpr* size : {&member.resource.width, &member.resource.height, &member.resource.count})
        for (const SizeExpr::Term& term : size->terms())
          if (term.op == SizeExpr::Op::ViewWidth || term.op == SizeExpr::Op::ViewHeight) return;
  const uint32_t p = static_cast<uint32_t>(&from - description_.passes.data());
  error(from.viewPlace, passPath(p, "view"),
        fmt::format("`{}` passes do not look through a camera", pass.declaration->type), "remove `view`");
}

// False if the value is of another type or out of range.
inline bool Binder::assign(const ParameterSpec& spec, const ParameterDescription& given, Value& out) const {
  using Type = ParameterSpec::Type;
  using Json = json::Value::Type;
  const auto inRange = [&] {
    return given.real >= spec.min && given.real <= spec.max && std::isfinite(given.real);
  };
  switch (spec.type) {
    case Type::Bool:
      if (given.type != Json::Bool) return false;
      out = given.integer != 0;
      return true;
    case Type::Int:
      if (given.type != Json::Int || !inRange()) return false;
      out = given.integer;
      return true;
    case Type::Real:
      if ((given.type != Json::Int && given.type != Json::Real) || !inRange()) return false;
      out = given.real;
      return true;
    default:
      return given.type == Json::String && assignText(spec, text(given.text), out);
  }
}

inline void Binder::readParameter(const ParameterSpec& spec, const ParameterDescription& given,
                                  const PassDescription& pass, Value& out) {
  if (!assign(spec, given, out)) readOther(spec, given, pass, out);
}

bool Binder::assignText(const ParameterSpec& spec, std::string_view given, Value& out) const {
  const std::vector<std::string>& choices = spec.choices;
  if (spec.type == ParameterSpec::Type::Choice &&
      std::find(choices.begin(), choices.end(), given) == choices.end())
    return false;
  out.emplace<std::string>(given);
  return true;
}

void Binder::bindParameters(BoundPass& pass, const PassDescription& from) {
  const std::vector<ParameterSpec>& specs = pass.declaration->parameters;
  pass.parameters = Parameters(&specs, values_.get(), values_->size());
  const ParameterDescription* given = description_.parameters.data() + from.firstParameter;
  const ParameterDescription* const end = given + from.parameterCount;
  for (const ParameterSpec& spec : specs) {  // mostly given in the order of declaration
    if (given != end && sameText(spec.name, given->name))
      readParameter(spec, *given++, from, values_->emplace_back());
    else
      values_->push_back(spec.defaultValue);
  }
  for (; given != end; ++given) bindParameter(specs, *given, from, values_->end() - specs.size());
}

// Binds a parameter that is given out of order or unknown.
void Binder::bindParameter(const std::vector<ParameterSpec>& specs, const ParameterDescription& given,
                           const PassDescription& from, std::vector<Value>::iterator values) {
  const std::string_view name = given.name;
  for (const ParameterSpec& spec : specs)
    if (spec.name == name) return readParameter(spec, given, from, values[&spec - specs.data()]);
  std::vector<std::string> names;
  for (const ParameterSpec& spec : specs) names.push_back(spec.name);
  const std::string nearest = nearestName(name, names);
  const uint32_t p = static_cast<uint32_t>(&from - description_.passes.data());
  error(given.keyPlace, passPath(p, json::joinPath("params", name)),
        fmt::format("`{}` has no parameter `{}`", graph_.passes[p].declaration->type, name),
        !nearest.empty() ? fmt::format("did you mean `{}`?", nearest)
        : names.empty()  ? std::string("it has none")
                         : fmt::format("it has: {}", fmt::join(names, ", ")));
}

namespace {

// Describes for a message what the user gave.
std::string describeGiven(const ParameterDescription& given, const SymbolTable& symbols) {
  switch (given.type) {
    case json::Value::Type::Bool:
      return given.integer ? "true" : "false";
    case json::Value::Type::Int:
      return std::to_string(given.integer);
    case json::Value::Type::Real:
      return fmt::format("{}", given.real);
    default:
      return fmt::format("`{}`", symbols[given.text]);
  }
}

// Reads command-line text as a number or flag; text that cannot be read stays text.
ParameterDescription parseTyped(ParameterDescription given, std::string_view text, ParameterSpec::Type type) {
  const char* end = text.data() + text.size();
  if (type == ParameterSpec::Type::Bool &&
      (text == "true" || text == "false" || text == "0" || text == "1")) {
    given.type = json::Value::Type::Bool;
    given.integer = text == "true" || text == "1";
  } else if (type == ParameterSpec::Type::Int || type == ParameterSpec::Type::Real) {
    if (const auto r = std::from_chars(text.data(), end, given.integer);
        r.ec == std::errc() && r.ptr == end) {
      given.type = json::Value::Type::Int;
      given.real = static_cast<double>(given.integer);
    } else if (const auto d = std::from_chars(text.data(), end, given.real);
               d.ec == std::errc() && d.ptr == end) {
      given.type = json::Value::Type::Real;
    }
  }
  return given;
}

std::string rangeText(const ParameterSpec& spec) {
  const char* kind = spec.type == ParameterSpec::Type::Int ? "a whole number" : "a number";
  if (std::isinf(spec.min) && std::isinf(spec.max)) return kind;
  if (std::isinf(spec.max)) return fmt::format("{} of at least {}", kind, spec.min);
  if (std::isinf(spec.min)) return fmt::format("{} of at most {}", kind, spec.max);
  return fmt::format("{} from {} to {}", kind, spec.min, spec.max);
}

}  // namespace

// Handles text from the command line, and mistakes.
void Binder::readOther(const ParameterSpec& spec, const ParameterDescription& given,
                       const PassDescription& pass, Value& out) {
  const bool typed = given.fromCommandLine && given.type == json::Value::Type::String;
  const ParameterDescription read = typed ? parseTyped(given, text(given.text), spec.type) : given;
  if (typed && assign(spec, read, out)) return;
  out = spec.defaultValue;
  reportParameter(spec, read, pass);
}

void Binder::reportParameter(const ParameterSpec& spec, const ParameterDescription& given,
                             const PassDescription& pass) {
  std::string expected, remedy;
  switch (spec.type) {
    case ParameterSpec::Type::Bool:
      expected = "true or false";
      break;
    case ParameterSpec::Type::Int:
    case ParameterSpec::Type::Real:
      expected = rangeText(spec);
      break;
    case ParameterSpec::Type::Choice:
      expected = fmt::format("one of {}", fmt::join(spec.choices, ", "));
      if (given.type == json::Value::Type::String) remedy = nearestName(text(given.text), spec.choices);
      break;
    case ParameterSpec::Type::Text:
      expected = "a text";
      break;
  }
  const uint32_t p = static_cast<uint32_t>(&pass - description_.passes.data());
  error(given.place, passPath(p, "params." + spec.name),
        fmt::format("parameter `{}`: expected {}, found {}", spec.name, expected,
                    describeGiven(given, description_.symbols)),
        remedy.empty() ? std::string() : fmt::format("did you mean `{}`?", remedy));
}

// ---- Resources ---------------------------------------------------------------------------------------

void Binder::makeExternals() {
  for (const ExternalDescription& external : description_.externals) {
    externalFirst_.push_back(static_cast<uint32_t>(graph_.resources.size()));
    for (size_t m = 0; m < external.members.size(); ++m) {
      BoundResource& resource = graph_.resources.emplace_back(Lifetime::Transient, 0);
      resource.name = text(external.name);
      if (!text(external.members[m]).empty()) (resource.name += '.') += text(external.members[m]);
      resource.desc = external.resources[m];
      if (resource.desc.kind == ResourceKind::Image && resource.desc.width == 0)
        resource.desc.width = viewExtents_[0].width;
      if (resource.desc.kind == ResourceKind::Image && resource.desc.height == 0)
        resource.desc.height = viewExtents_[0].height;
      resource.external = true;
      resourcePass_.push_back(kNone);
      resourceSpec_.push_back(nullptr);
    }
  }
}

void Binder::makeResources() {
  const size_t count = graph_.resources.size() + resourceCount_;
  graph_.resources.reserve(count);
  versions_.reserve(count);
  resourcePass_.reserve(count);
  resourceSpec_.reserve(count);
  for (PortState& port : ports_) {
    const PortSpec& spec = *port.spec;
    if (!makes(spec)) continue;
    port.value = {static_cast<uint32_t>(graph_.resources.size()), static_cast<uint32_t>(spec.members.size()),
                  &spec, kNone, kNone};
    port.state = 2;
    port.firstVersion = static_cast<uint32_t>(versions_.size());
    const std::string& pass = graph_.passes[port.pass].name;
    for (const MemberSpec& member : spec.members) {
      BoundResource& resource = graph_.resources.emplace_back(spec.lifetime, 1);
      const size_t length = pass.size() + spec.name.size() + member.name.size() + 2;
      if (length > resource.name.capacity()) resource.name.reserve(length);
      ((resource.name += pass) += '.') += spec.name;
      if (!member.name.empty()) (resource.name += '.') += member.name;
      versions_.push_back(1);
      resourcePass_.push_back(port.pass);
      resourceSpec_.push_back(&member);
    }
  }
}

// ---- Accesses ----------------------------------------------------------------------------------------

void Binder::makeAccesses() {
  const PortState* port = ports_.data();
  for (BoundPass& pass : graph_.passes) {
    const PortState* const end = port + (pass.declaration ? pass.declaration->ports.size() : 0);
    pass.accesses.reserve(end - port);
    for (; port != end; ++port)
      if (port->value.first != kNone) addAccesses(pass, *port);
  }
}

inline void Binder::addAccesses(BoundPass& pass, const PortState& port) {
  const PortSpec& spec = *port.spec;
  const bool input = spec.direction == Direction::Input, inout = spec.direction == Direction::InOut;
  const bool reads = input || inout || spec.lifetime != Lifetime::Transient;  // previous contents matter
  history_ |= port.previous;
  uint16_t m = 0;
  for (const MemberSpec& member : spec.members) {
    const uint32_t r = resourceOf(port, m);
    if (r == kNone) {
      ++m;
      continue;
    }
    BoundResource& resource = graph_.resources[r];
    resource.usage |= static_cast<uint32_t>(member.usage);
    uint32_t version = 1;
    if (port.previous)
      version = 0;
    else if (input)
      version = versionSeen(port, r);
    else if (inout && port.firstVersion != kNone)  // otherwise part of a cycle that has been reported
      version = versions_[port.firstVersion + (r - port.value.first)];
    const uint32_t slot = resource.firstSlot + (port.previous ? resource.versions + 1 : version);
    pass.accesses.emplace_back(r, port.index, m++, member.usage, reads, !input, port.previous, version, slot);
  }
}

void Binder::bindOutputs() {
  graph_.outputs.reserve(description_.outputs.size());
  for (const WireDescription& wire : description_.outputs) {
    PortState port(nullptr, kNone, 0);
    connectWire(port, wire);
    if (port.value.first == kNone) continue;
    const bool bundle = port.value.origin && port.value.member == kNone && !port.value.origin->bundle.empty();
    for (uint32_t m = 0; m < port.value.count; ++m) {
      const uint32_t resource = port.value.first + m;
      BoundOutput output;
      output.name = wire.target;
      if (bundle) output.name += "." + port.value.origin->members[m].name;
      output.resource = resource;
      output.version = versionSeen(port, resource);
      if (output.version != graph_.resources[resource].versions)
        error(wire.place, json::joinPath("outputs", wire.target),
              fmt::format("`{}` is updated in place later in the frame", wire.written),
              "wire the output to the last pass that updates it");
      graph_.resources[resource].output = true;
      graph_.resources[resource].usage |= static_cast<uint32_t>(Usage::TransferRead);
      graph_.outputs.push_back(std::move(output));
    }
  }
}

// A history edge reads what the resource held at the end of the last frame.
void Binder::markHistory() {
  for (PortState& port : ports_) {
    if (!port.previous || port.value.first == kNone) continue;
    const WireDescription& wire = description_.wires[port.wire];
    for (uint32_t m = 0; m < port.spec->members.size(); ++m) {
      const uint32_t r = resourceOf(port, m);
      if (r == kNone) continue;
      BoundResource& resource = graph_.resources[r];
      resource.history = true;
      if (resource.external)
        error(wire.place, wirePath(port), "an input of the graph has no history",
              "wire it without `@previous`");
      else if (resource.lifetime != Lifetime::Transient)
        error(wire.place, wirePath(port),
              fmt::format("`{}` is kept and updated in place, so last frame's value is gone", resource.name),
              "wire it without `@previous`, or make its pass declare it without keep()");
      else if (port.source != kNone && versionSeen(port, r) != resource.versions)
        error(wire.place, wirePath(port),
              fmt::format("`{}` is updated in place later in the frame", wire.written),
              "`@previous` holds the last update: wire the pass that makes it");
    }
  }
}

uint64_t Binder::hash() const {
  Hasher h;
  for (size_t p = 0; p < graph_.passes.size(); ++p) {
    const BoundPass& pass = graph_.passes[p];
    const SymbolTable& symbols = description_.symbols;
    h.add(symbols.hash(description_.passes[p].name), symbols.hash(description_.passes[p].type));
    h.add(pass.view);
    for (const Value& value : pass.parameters.values()) h.add(value);
    for (const Access& a : pass.accesses)
      h.add(uint64_t(a.resource) << 32 | uint64_t(a.port) << 16 | a.member,
            uint64_t(a.version) << 32 | uint64_t(a.usage) << 3 | uint64_t(a.previous) << 2 |
                uint64_t(a.reads) << 1 | uint64_t(a.writes));
  }
  for (const BoundResource& r : graph_.resources) {
    const ResourceDesc& d = r.desc;
    h.add(uint64_t(d.width) << 32 | d.height, uint64_t(d.depth) << 32 | d.layers);
    h.add(uint64_t(d.format) << 32 | uint64_t(d.mips) << 8 | uint64_t(d.kind) << 7 | uint64_t(d.volume) << 6 |
              uint64_t(d.array) << 5 | uint64_t(r.external) << 4 | uint64_t(r.history) << 3 |
              uint64_t(r.output) << 2 | uint64_t(r.lifetime),
          d.count * 31 + d.stride);
  }
  for (const BoundOutput& o : graph_.outputs) h.add(o.name), h.add(o.resource);
  for (const std::string& view : graph_.views) h.add(view);
  return h.value();
}

}  // namespace detail
}  // namespace fovea::graph
