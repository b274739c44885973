// Bind, sizes: evaluates size expressions over views, parameters and inputs, and checks the device's limits.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "framework/graph/compile/binding.h"
#include "framework/graph/pass/evaluate.h"

namespace fovea::graph::detail {
namespace {

using Op = SizeExpr::Op;

// 1 TiB. No device has as much, and byte counts below this limit never overflow.
constexpr double kMaxBytes = 1099511627776.0;
constexpr int kMaxDepth = 2000;  // passes whose sizes depend on each other through history edges

// An upper bound: every texel has the size of the largest format, and all mips together twice that of the first.
double bytesOf(const ResourceDesc& d) {
  if (d.kind == ResourceKind::Buffer) return static_cast<double>(d.count) * d.stride;
  return 32.0 * d.width * d.height * d.depth * d.layers;
}

// The sizes of passes are evaluated on demand, because a size may follow from those of inputs.
enum class State : uint8_t { Pending, InProgress, Done, Failed };
struct Sizes {
  Binding& b;
  std::vector<State> states;  // per pass
};

bool evaluatePass(Sizes& sizes, uint32_t p, int depth);

// The names of what sizes depend on: "radius", "count".
std::vector<std::string> quantitiesOf(const SizeExpr& sizes) {
  std::vector<std::string> names;
  for (const SizeExpr::Term& term : sizes.terms())
    if (term.op >= Op::Parameter && term.op <= Op::Environment)
      if (std::find(names.begin(), names.end(), term.name) == names.end()) names.push_back(term.name);
  return names;
}

// All terms of the sizes of a resource, one after another.
SizeExpr allSizes(const ResourceSpec& spec) {
  std::vector<SizeExpr::Term> terms;
  for (const SizeExpr* size : {&spec.width, &spec.height, &spec.depth, &spec.layers, &spec.count})
    terms.insert(terms.end(), size->terms().begin(), size->terms().end());
  return SizeExpr(std::move(terms));
}

// Reports a size at the value from which it follows, or else at the pass. A value that gives several wrong sizes is
// reported once. `remedy` begins the advice, and the name of that value follows; `choices`, if there are any, are the
// whole advice instead.
void reportSize(Binding& b, uint32_t p, const ResourceSpec& spec, std::string message, std::string remedy,
                std::string_view otherwise, const std::string& choices = {}) {
  const SizeExpr sizes = allSizes(spec);
  const std::vector<std::string> names = quantitiesOf(sizes);
  const std::optional<GivenValue> given = nearestSource(b, p, sizes);
  const json::Position where = given ? given->where : b.description.passes[p].written->keyWhere;
  const std::string path = given ? given->path : passPath(b, p);
  const SourceLocation location = where.location();
  for (const Diagnostic& d : b.diagnostics.list())
    if (d.where.file == location.file && d.where.line == location.line && d.where.column == location.column &&
        d.path == path)
      return;
  if (!choices.empty())
    remedy = choices;
  else if (names.empty())
    remedy = otherwise;
  else if (given)
    remedy += fmt::format("`{}`", given->name);
  else
    remedy += fmt::format("`{}`", fmt::join(names, "`, `"));
  report(b, where, path, std::move(message), std::move(remedy));
}

// ---- Expressions -------------------------------------------------------------------------------------
// Nothing if a size is not known, for the reason in `why`; "" if that has been reported.

std::optional<int64_t> sizeOfPort(Sizes& sizes, uint32_t p, const SizeExpr::Term& term, int depth,
                                  std::string& why) {
  const std::string_view input = std::string_view(term.name).substr(0, term.name.find('.'));
  for (const Port& port : sizes.b.portsOf(p)) {
    if (port.spec->name != input || port.wire || !port.spec->optional) continue;
    why = fmt::format("needs the size of the input `{}`, which is not wired", input);
    return std::nullopt;
  }
  const uint32_t r = resourceNamed(sizes.b, p, term.name);
  if (r == kNone) return std::nullopt;
  const uint32_t producer = sizes.b.origins[r].pass;
  if (producer != kNone && sizes.states[producer] == State::InProgress) {
    why = "depends on itself";
    return std::nullopt;
  }
  if (producer != kNone && !evaluatePass(sizes, producer, depth + 1)) return std::nullopt;
  return quantityOf(sizes.b.graph.resources[r].desc, term.op);
}

std::optional<int64_t> evaluateTerm(Sizes& sizes, uint32_t p, const SizeExpr::Term& term, int depth,
                                    std::string& why) {
  const BoundPass& pass = sizes.b.graph.passes[p];
  int64_t quantity = 1;
  switch (term.op) {
    case Op::Constant:
      return term.constant;
    case Op::ViewWidth:
      return sizes.b.viewExtents[pass.view].width;
    case Op::ViewHeight:
      return sizes.b.viewExtents[pass.view].height;
    case Op::Parameter:
      return wholeNumber(pass.parameters, term.name);
    case Op::Environment:
      for (const auto& [name, value] : sizes.b.environment.quantities)
        if (name == term.name) quantity = std::max<int64_t>(1, value);
      return quantity;
    case Op::Wired:
      for (const Port& port : sizes.b.portsOf(p))
        if (port.spec->name == term.name) return port.wire != nullptr;
      return 0;
    default:
      return sizeOfPort(sizes, p, term, depth, why);
  }
}

// ---- Limits ------------------------------------------------------------------------------------------

bool withinLimits(const Environment& environment, const MemberSpec& member, const ResourceDesc& d) {
  if (bytesOf(d) > kMaxBytes) return false;
  if (d.kind == ResourceKind::Buffer) {
    const uint64_t limit = environment.maxStorageBufferRange;
    // Uniform buffers may exceed the device's range, because passes bind them page by page.
    return limit == 0 || d.count * d.stride <= limit ||
           !any(member.usage, Usage::StorageRead | Usage::StorageWrite);
  }
  const uint32_t limit = d.volume ? environment.maxImageDimension3D : environment.maxImageDimension2D;
  if (limit && std::max({d.width, d.height, d.depth}) > limit) return false;
  return !d.array || !environment.maxImageArrayLayers || d.layers <= environment.maxImageArrayLayers;
}

// "set edge-filter.layout to `tiled`": if a size depends on a choice, another choice may avoid exceeding a limit.
std::string otherChoices(const BoundPass& pass, const ResourceSpec& spec) {
  std::string remedy;
  for (const ParameterSpec& parameter : pass.declaration->parameters) {
    if (parameter.type != ParameterSpec::Type::Choice) continue;
    const bool counts = std::any_of(
        spec.layers.terms().begin(), spec.layers.terms().end(),
        [&](const auto& term) { return term.op == Op::Parameter && term.name == parameter.name; });
    const Value* value = pass.parameters.find(parameter.name);
    std::string others;
    for (const std::string& choice : parameter.choices)
      if (counts && value && *value != Value(choice))
        others += (others.empty() ? "`" : " or `") + choice + "`";
    if (!others.empty())
      remedy +=
          fmt::format("{}set {}.{} to {}", remedy.empty() ? "" : ", or ", pass.name, parameter.name, others);
  }
  return remedy;
}

std::string describeExcess(const Environment& environment, const ResourceDesc& d) {
  if (bytesOf(d) > kMaxBytes) {
    return d.kind == ResourceKind::Buffer
               ? fmt::format("{} elements of {} bytes are more than any device holds", d.count, d.stride)
               : fmt::format("{}x{}x{} with {} layers is more than any device holds", d.width, d.height,
                             d.depth, d.layers);
  }
  if (d.kind == ResourceKind::Buffer) {
    return fmt::format("{} elements of {} bytes exceed this device's maxStorageBufferRange {}", d.count,
                       d.stride, environment.maxStorageBufferRange);
  }
  if (d.array && environment.maxImageArrayLayers && d.layers > environment.maxImageArrayLayers) {
    return fmt::format("{} layers of {}x{} exceed this device's maxImageArrayLayers {}", d.layers, d.width,
                       d.height, environment.maxImageArrayLayers);
  }
  return fmt::format("{}x{}{} exceeds this device's {} {}", d.width, d.height,
                     d.volume ? fmt::format("x{}", d.depth) : std::string(),
                     d.volume ? "maxImageDimension3D" : "maxImageDimension2D",
                     d.volume ? environment.maxImageDimension3D : environment.maxImageDimension2D);
}

void reportLimits(Binding& b, uint32_t p, const PortSpec& spec, const MemberSpec& member,
                  const ResourceDesc& desc) {
  const BoundPass& pass = b.graph.passes[p];
  reportSize(b, p, member.resource,
             fmt::format("pass `{}`: `{}`: {}", pass.name, memberPath(spec, member),
                         describeExcess(b.environment, desc)),
             "lower what it follows from: ", "render at a smaller size", otherChoices(pass, member.resource));
}

// ---- Resources ---------------------------------------------------------------------------------------

// False, after a message, if a size is not known or out of range.
bool evaluateResource(Sizes& sizes, uint32_t p, const PortSpec& spec, const MemberSpec& member,
                      ResourceDesc& desc, int depth) {
  constexpr int64_t kMaxExtent = 1 << 24, kMaxCount = int64_t(1) << 40;
  const ResourceSpec& from = member.resource;
  desc.kind = from.kind;
  desc.format = from.format;
  desc.volume = from.volume;
  desc.array = from.array;
  desc.light = from.light;
  desc.stride = from.stride;
  bool good = true;
  const auto evaluateInto = [&]<class T>(T& out, const SizeExpr& size, const char* what, int64_t limit) {
    std::string why;
    const std::optional<int64_t> value = evaluate(
        size, why, [&](const SizeExpr::Term& term) { return evaluateTerm(sizes, p, term, depth, why); });
    if (value && *value >= 1 && *value <= limit) {
      out = static_cast<T>(*value);
      return;
    }
    good = false;
    if (value) why = fmt::format("is {}, it must be from 1 to {}", *value, limit);
    if (why.empty()) return;
    reportSize(sizes.b, p, from,
               fmt::format("pass `{}`: {} of `{}`, {}, {}", sizes.b.graph.passes[p].name, what,
                           memberPath(spec, member), size.print(), why),
               "it depends on ", {});
  };
  if (from.kind == ResourceKind::Buffer) {
    desc.element = from.element;
    evaluateInto(desc.count, from.count, "the count", kMaxCount);
    return good;
  }
  evaluateInto(desc.width, from.width, "the width", kMaxExtent);
  evaluateInto(desc.height, from.height, "the height", kMaxExtent);
  if (from.volume) evaluateInto(desc.depth, from.depth, "the depth", kMaxExtent);
  if (from.array) evaluateInto(desc.layers, from.layers, "the number of layers", kMaxExtent);
  evaluateInto(desc.mips, from.mips, "the number of mip levels", 32);
  // The device would refuse more levels than the size has; expressions may ask for "enough" of them.
  desc.mips = std::min(desc.mips, uint32_t(std::bit_width(std::max({desc.width, desc.height, desc.depth}))));
  return good;
}

bool evaluatePass(Sizes& sizes, uint32_t p, int depth) {
  State& state = sizes.states[p];
  if (state != State::Pending) return state == State::Done;
  if (!sizes.b.graph.passes[p].declaration || depth > kMaxDepth) return false;
  state = State::InProgress;
  bool good = true;
  for (const Port& port : sizes.b.portsOf(p)) {
    const PortSpec& spec = *port.spec;
    if (!makes(spec)) continue;
    for (uint32_t m = 0; m < spec.members.size(); ++m) {
      ResourceDesc& desc = sizes.b.graph.resources[port.value.first + m].desc;
      if (!evaluateResource(sizes, p, spec, spec.members[m], desc, depth))
        good = false;
      else if (!withinLimits(sizes.b.environment, spec.members[m], desc))
        reportLimits(sizes.b, p, spec, spec.members[m], desc);
    }
  }
  state = good ? State::Done : State::Failed;
  return good;
}

void checkExternal(Binding& b, const ExternalDescription& external, const ResourceDesc& d) {
  const uint32_t limit = d.volume ? b.environment.maxImageDimension3D : b.environment.maxImageDimension2D;
  if (bytesOf(d) > kMaxBytes)
    report(b, external.where, json::joinPath("inputs", external.name), "this is more than any device holds",
           "lower its size");
  else if (d.kind == ResourceKind::Image && limit && std::max({d.width, d.height, d.depth}) > limit)
    report(b, external.where, json::joinPath("inputs", external.name),
           fmt::format("{}x{}x{} exceeds this device's maximum image size {}", d.width, d.height, d.depth,
                       limit));
}

}  // namespace

void evaluateSizes(Binding& b, std::span<const uint32_t> order) {
  Sizes sizes{b, std::vector<State>(b.graph.passes.size(), State::Pending)};
  for (const uint32_t p : order) evaluatePass(sizes, p, 0);
  for (uint32_t p = 0; p < b.graph.passes.size(); ++p) evaluatePass(sizes, p, 0);  // those on a cycle
  for (size_t e = 0; e < b.description.externals.size(); ++e) {
    const ExternalDescription& external = b.description.externals[e];
    for (size_t m = 0; m < external.members.size(); ++m)
      checkExternal(b, external, b.graph.resources[b.firstOfExternal[e] + m].desc);
  }
}

}  // namespace fovea::graph::detail
