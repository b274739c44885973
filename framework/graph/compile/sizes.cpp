// Bind, sizes: evaluates size expressions over views, parameters and inputs, and checks the device's limits.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>

#include "framework/graph/compile/binder.h"

namespace fovea::graph::detail {

namespace {

// 1 TiB. No device has as much, and byte counts below this limit never overflow.
constexpr double kMaxBytes = 1099511627776.0;
constexpr int kMaxDepth = 2000;  // passes whose sizes depend on each other through history edges

// An upper bound: every texel has the size of the largest format, and all mips together twice that of the first.
double bytesOf(const ResourceDesc& d) {
  if (d.kind == ResourceKind::Buffer) return static_cast<double>(d.count) * d.stride;
  return 32.0 * d.width * d.height * d.depth * d.layers;
}

struct Stack {
  int64_t values[64];
  int size = 0;
};

// False on overflow, on division by zero, and if an expression is too deep.
bool apply(SizeExpr::Op op, Stack& stack) {
  using Op = SizeExpr::Op;
  if (stack.size < 2) return false;
  const int64_t b = stack.values[--stack.size];
  int64_t& a = stack.values[stack.size - 1];
  switch (op) {
    case Op::Add:
      return !__builtin_add_overflow(a, b, &a);
    case Op::Sub:
      return !__builtin_sub_overflow(a, b, &a);
    case Op::Mul:
      return !__builtin_mul_overflow(a, b, &a);
    case Op::Div:
      if (b <= 0 || a < 0) return false;
      a = a / b + (a % b != 0);
      return true;
    case Op::Min:
      a = std::min(a, b);
      return true;
    default:
      a = std::max(a, b);
      return true;
  }
}

// Most sizes are a number or a size of the view; returns 0 for all others.
inline int64_t sizeAtOnce(const SizeExpr& size, VkExtent2D view) {
  if (size.terms().size() != 1) return 0;
  const SizeExpr::Term& term = size.terms()[0];
  if (term.op == SizeExpr::Op::Constant) return term.constant;
  return term.op == SizeExpr::Op::ViewWidth    ? view.width
         : term.op == SizeExpr::Op::ViewHeight ? view.height
                                               : 0;
}

}  // namespace

void Binder::evaluateSizes() {
  sized_ = scratch_.array<uint8_t>(graph_.passes.size());
  for (const uint32_t p : order_) evaluatePass(p, 0);
  for (uint32_t p = 0; p < graph_.passes.size() && order_.size() < graph_.passes.size(); ++p)
    evaluatePass(p, 0);
  for (uint32_t e = 0; e < externalFirst_.size(); ++e) {
    for (uint32_t m = 0; m < description_.externals[e].members.size(); ++m) {
      const ResourceDesc& d = graph_.resources[externalFirst_[e] + m].desc;
      const uint32_t limit = d.volume ? environment_.maxImageDimension3D : environment_.maxImageDimension2D;
      if (bytesOf(d) > kMaxBytes)
        error(description_.externals[e].place, json::joinPath("inputs", text(description_.externals[e].name)),
              "this is more than any device holds", "lower its size");
      else if (d.kind == ResourceKind::Image && limit && std::max({d.width, d.height, d.depth}) > limit)
        error(description_.externals[e].place, json::joinPath("inputs", text(description_.externals[e].name)),
              fmt::format("{}x{}x{} exceeds this device's maximum image size {}", d.width, d.height, d.depth,
                          limit));
    }
  }
}

inline bool Binder::evaluateResource(uint32_t p, const PortSpec& spec, const MemberSpec& member,
                                     VkExtent2D view, BoundResource& resource, int depth) {
  const ResourceSpec& from = member.resource;
  ResourceDesc& desc = resource.desc;
  desc.kind = from.kind;
  desc.format = from.format;
  desc.volume = from.volume;
  desc.array = from.array;
  desc.stride = from.stride;
  constexpr int64_t kMaxExtent = 1 << 24, kMaxCount = int64_t(1) << 40;
  auto size = [&](const SizeExpr& expr, const char* what, int64_t limit, auto& out) {
    int64_t value = sizeAtOnce(expr, view);
    if ((value < 1 || value > limit) && !evaluateSize(p, spec, member, expr, what, limit, value, depth))
      return false;
    out = static_cast<std::remove_reference_t<decltype(out)>>(value);
    return true;
  };
  if (from.kind == ResourceKind::Buffer) {
    desc.element = from.element;
    return size(from.count, "the count", kMaxCount, desc.count);
  }
  bool good = size(from.width, "the width", kMaxExtent, desc.width);
  good = size(from.height, "the height", kMaxExtent, desc.height) && good;
  if (from.volume) good = size(from.depth, "the depth", kMaxExtent, desc.depth) && good;
  if (from.array) good = size(from.layers, "the number of layers", kMaxExtent, desc.layers) && good;
  good = size(from.mips, "the number of mip levels", 32, desc.mips) && good;
  // The device would refuse more levels than the size has; expressions may ask for "enough" of them.
  desc.mips = std::min(desc.mips, uint32_t(std::bit_width(std::max({desc.width, desc.height, desc.depth}))));
  return good;
}

inline bool Binder::withinLimits(const MemberSpec& member, const ResourceDesc& d) const {
  if (bytesOf(d) > kMaxBytes) return false;
  if (d.kind == ResourceKind::Buffer) {
    const uint64_t limit = environment_.maxStorageBufferRange;
    // Uniform buffers may exceed the device's range, because passes bind them page by page.
    return limit == 0 || d.count * d.stride <= limit ||
           !any(member.usage, Usage::StorageRead | Usage::StorageWrite);
  }
  const uint32_t limit = d.volume ? environment_.maxImageDimension3D : environment_.maxImageDimension2D;
  if (limit && std::max({d.width, d.height, d.depth}) > limit) return false;
  return !d.array || !environment_.maxImageArrayLayers || d.layers <= environment_.maxImageArrayLayers;
}

bool Binder::evaluatePass(uint32_t p, int depth) {
  if (sized_[p] != 0) return sized_[p] == 2;
  const PassDeclaration* declaration = graph_.passes[p].declaration;
  if (!declaration || depth > kMaxDepth) return false;
  sized_[p] = 1;
  const VkExtent2D view = viewExtents_[graph_.passes[p].view];
  bool good = true;
  for (const PortState& port : std::span(portsOf(p), portCount(p))) {
    const PortSpec& spec = *port.spec;
    if (!makes(spec)) continue;
    BoundResource* resource = &graph_.resources[port.value.first];
    for (const MemberSpec& member : spec.members) {
      if (!evaluateResource(p, spec, member, view, *resource, depth))
        good = false;
      else if (!withinLimits(member, resource->desc))
        reportLimits(p, spec, member, resource->desc);
      ++resource;
    }
  }
  sized_[p] = good ? 2 : 3;
  return good;
}

// Evaluates one size of a resource, from 1 to `limit`. False, with a message, if it is not in this range.
bool Binder::evaluateSize(uint32_t p, const PortSpec& spec, const MemberSpec& member, const SizeExpr& size,
                          const char* what, int64_t limit, int64_t& out, int depth) {
  std::string why;
  const std::vector<SizeExpr::Term>& terms = size.terms();
  const bool known = terms.size() == 1 && terms[0].op < SizeExpr::Op::Add
                         ? evaluateTerm(p, terms[0], out, depth, why)
                         : evaluate(p, size, out, depth, why);
  if (!known && why.empty()) return false;  // the cause has been reported
  if (known && out >= 1 && out <= limit) return true;
  if (known) why = fmt::format("is {}, it must be from 1 to {}", out, limit);
  const std::string port = member.name.empty() ? spec.name : spec.name + "." + member.name;
  const std::string names = parametersOf(member.resource);
  error(description_.passes[p].place, passPath(p),
        fmt::format("pass `{}`: {} of `{}`, {}, {}", graph_.passes[p].name, what, port, size.print(), why),
        names.empty() ? std::string() : fmt::format("it depends on {}", names));
  return false;
}

bool Binder::evaluate(uint32_t pass, const SizeExpr& size, int64_t& out, int depth, std::string& why) {
  Stack stack;
  for (const SizeExpr::Term& term : size.terms()) {
    if (term.op >= SizeExpr::Op::Add) {
      if (apply(term.op, stack)) continue;
      why = "overflows or divides by zero";
      return false;
    }
    if (stack.size == 64) {
      why = "is too long an expression";
      return false;
    }
    if (!evaluateTerm(pass, term, stack.values[stack.size++], depth, why)) return false;
  }
  out = stack.values[0];
  return true;
}

bool Binder::evaluateTerm(uint32_t p, const SizeExpr::Term& term, int64_t& out, int depth, std::string& why) {
  using Op = SizeExpr::Op;
  const BoundPass& pass = graph_.passes[p];
  switch (term.op) {
    case Op::Constant:
      out = term.constant;
      return true;
    case Op::ViewWidth:
      out = viewExtents_[pass.view].width;
      return true;
    case Op::ViewHeight:
      out = viewExtents_[pass.view].height;
      return true;
    case Op::Parameter: {
      const Value* value = pass.parameters.find(term.name);
      const int64_t* number = value ? std::get_if<int64_t>(value) : nullptr;
      const std::string* chosen = value ? std::get_if<std::string>(value) : nullptr;
      const bool* flag = value ? std::get_if<bool>(value) : nullptr;
      out = number ? *number : flag && *flag ? 1 : 0;
      if (!chosen) return number || flag;
      for (const ParameterSpec& spec : pass.declaration->parameters) {  // a choice counts as its index
        const auto found = std::find(spec.choices.begin(), spec.choices.end(), *chosen);
        if (spec.name == term.name) out = found - spec.choices.begin();
      }
      return true;
    }
    case Op::Environment:
      out = 1;
      for (const auto& [name, value] : environment_.quantities)
        if (name == term.name) out = std::max<int64_t>(1, value);
      return true;
    default:
      return sizeOfPort(p, term, out, depth, why);
  }
}

bool Binder::sizeOfPort(uint32_t p, const SizeExpr::Term& term, int64_t& out, int depth, std::string& why) {
  using Op = SizeExpr::Op;
  const std::vector<PortSpec>& specs = graph_.passes[p].declaration->ports;
  const std::string_view name = term.name;
  const size_t dot = name.find('.');
  const std::string_view portName = name.substr(0, dot);
  const std::string_view memberName =
      dot == std::string_view::npos ? std::string_view() : name.substr(dot + 1);
  for (uint32_t i = 0; i < specs.size(); ++i) {
    if (specs[i].name != portName) continue;
    const PortState& port = portsOf(p)[i];
    if (port.wire == kNone && specs[i].optional) {
      why = fmt::format("needs the size of the input `{}`, which is not wired", portName);
      return false;
    }
    for (uint32_t m = 0; m < specs[i].members.size(); ++m) {
      if (specs[i].members[m].name != memberName) continue;
      const uint32_t r = resourceOf(port, m);
      if (r == kNone) return false;
      const uint32_t producer = resourcePass_[r];
      if (producer != kNone && sized_[producer] == 1) {
        why = "depends on itself";
        return false;
      }
      if (producer != kNone && !evaluatePass(producer, depth + 1)) return false;
      const ResourceDesc& desc = graph_.resources[r].desc;
      out = term.op == Op::PortWidth    ? desc.width
            : term.op == Op::PortHeight ? desc.height
            : term.op == Op::PortLayers ? (desc.volume ? desc.depth : desc.layers)
                                        : static_cast<int64_t>(desc.count);
      return true;
    }
  }
  return false;
}

// ---- Limits ------------------------------------------------------------------------------------------

std::string Binder::parametersOf(const ResourceSpec& spec) const {
  std::vector<std::string> names;
  for (const SizeExpr* size : {&spec.width, &spec.height, &spec.depth, &spec.layers, &spec.count})
    for (const SizeExpr::Term& term : size->terms())
      if (term.op == SizeExpr::Op::Parameter ||
          (term.op >= SizeExpr::Op::PortWidth && term.op <= SizeExpr::Op::Environment))
        if (std::find(names.begin(), names.end(), term.name) == names.end()) names.push_back(term.name);
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
  return text;
}

void Binder::reportLimits(uint32_t p, const PortSpec& spec, const MemberSpec& member, const ResourceDesc& d) {
  std::string what;
  if (bytesOf(d) > kMaxBytes) {
    what = d.kind == ResourceKind::Buffer
               ? fmt::format("{} elements of {} bytes are more than any device holds", d.count, d.stride)
               : fmt::format("{}x{}x{} with {} layers is more than any device holds", d.width, d.height,
                             d.depth, d.layers);
  } else if (d.kind == ResourceKind::Buffer) {
    what = fmt::format("{} elements of {} bytes exceed this device's maxStorageBufferRange {}", d.count,
                       d.stride, environment_.maxStorageBufferRange);
  } else if (d.array && environment_.maxImageArrayLayers && d.layers > environment_.maxImageArrayLayers) {
    what = fmt::format("{} layers of {}x{} exceed this device's maxImageArrayLayers {}", d.layers, d.width,
                       d.height, environment_.maxImageArrayLayers);
  } else {
    what = fmt::format("{}x{}{} exceeds this device's {} {}", d.width, d.height,
                       d.volume ? fmt::format("x{}", d.depth) : std::string(),
                       d.volume ? "maxImageDimension3D" : "maxImageDimension2D",
                       d.volume ? environment_.maxImageDimension3D : environment_.maxImageDimension2D);
  }
  const std::string names = parametersOf(member.resource);
  const std::string choices = otherChoices(p, member.resource);
  error(description_.passes[p].place, passPath(p),
        fmt::format("pass `{}`: `{}`: {}", graph_.passes[p].name,
                    member.name.empty() ? spec.name : spec.name + "." + member.name, what),
        !choices.empty() ? choices
        : names.empty()  ? std::string("render at a smaller size")
                         : fmt::format("lower what it follows from: {}", names));
}

// "set edge-filter.layout to `tiled`": if a size depends on a choice, another choice may avoid exceeding a limit.
std::string Binder::otherChoices(uint32_t p, const ResourceSpec& spec) const {
  const BoundPass& pass = graph_.passes[p];
  std::string remedy;
  for (const ParameterSpec& parameter : pass.declaration->parameters) {
    if (parameter.type != ParameterSpec::Type::Choice) continue;
    const bool counts = std::any_of(
        spec.layers.terms().begin(), spec.layers.terms().end(),
        [&](const auto& term) { return term.op == SizeExpr::Op::Parameter && term.name == parameter.name; });
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

}  // namespace fovea::graph::detail
