// What a bound pass knows of its place in the graph.
#include <fmt/format.h>

#include <algorithm>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/graph/compile/plan.h"

namespace fovea::graph {
namespace {

bool isPath(const PortSpec& port, const MemberSpec& member, std::string_view path) {
  if (member.name.empty()) return path == port.name;
  return path.size() == port.name.size() + 1 + member.name.size() && path.starts_with(port.name) &&
         path[port.name.size()] == '.' && path.ends_with(member.name);
}

// A bundle is wired if one of its members is.
bool isWired(const BoundPass& pass, std::string_view port) {
  return std::any_of(pass.accesses.begin(), pass.accesses.end(), [&](const Access& a) {
    const PortSpec& spec = pass.declaration->ports[a.port];
    return spec.name == port || isPath(spec, spec.members[a.member], port);
  });
}

const ResourceDesc& descOf(const BoundGraph& graph, const BoundPass& pass, std::string_view path) {
  return graph.resources[pass.accesses[accessOf(pass, path)].resource].desc;
}

int64_t parameterNumber(const BoundPass& pass, const std::string& name) {
  const Value& value = *pass.parameters.find(name);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  if (const auto* number = std::get_if<int64_t>(&value)) return *number;
  for (const ParameterSpec& spec : pass.declaration->parameters)
    if (spec.name == name && spec.type == ParameterSpec::Type::Choice)
      return std::find(spec.choices.begin(), spec.choices.end(), std::get<std::string>(value)) -
             spec.choices.begin();
  throw Error(ExitCode::Internal, fmt::format("pass `{}` ({}) counts with `{}`, which is not a whole number",
                                              pass.name, pass.declaration->type, name));
}

int64_t sizeOf(SizeExpr::Op what, const ResourceDesc& desc) {
  switch (what) {
    case SizeExpr::Op::PortWidth:
      return desc.width;
    case SizeExpr::Op::PortHeight:
      return desc.height;
    case SizeExpr::Op::PortLayers:
      return std::max(desc.depth, desc.layers);
    default:
      return static_cast<int64_t>(desc.count);
  }
}

int64_t apply(SizeExpr::Op op, int64_t a, int64_t b) {
  using Op = SizeExpr::Op;
  switch (op) {
    case Op::Add:
      return a + b;
    case Op::Sub:
      return a - b;
    case Op::Mul:
      return a * b;
    case Op::Div:
      return b > 0 ? (a + b - 1) / b : 0;
    case Op::Min:
      return std::min(a, b);
    default:
      return std::max(a, b);
  }
}

}  // namespace

uint32_t accessOf(const BoundPass& pass, std::string_view path) {
  std::vector<std::string> known;
  for (uint32_t i = 0; i < pass.accesses.size(); ++i) {
    const PortSpec& port = pass.declaration->ports[pass.accesses[i].port];
    const MemberSpec& member = port.members[pass.accesses[i].member];
    if (isPath(port, member, path)) return i;
    known.push_back(member.name.empty() ? port.name : port.name + "." + member.name);
  }
  const std::string nearest = nearestName(path, known);
  throw Error(ExitCode::Internal,
              fmt::format("pass `{}` ({}) asks for `{}`, which is not one of its wired ports", pass.name,
                          pass.declaration->type, path),
              nearest.empty() ? "" : fmt::format("did you mean `{}`?", nearest));
}

const Parameters& PassContext::parameters() const { return bound_.parameters; }
bool PassContext::has(std::string_view port) const { return isWired(bound_, port); }

bool PassContext::isRead(std::string_view path) const {
  const uint32_t index = bound_.accesses[accessOf(bound_, path)].resource;
  if (graph_.resources[index].output || graph_.resources[index].history) return true;
  return std::any_of(graph_.passes.begin(), graph_.passes.end(), [&](const BoundPass& pass) {
    return &pass != &bound_ && std::any_of(pass.accesses.begin(), pass.accesses.end(),
                                           [&](const Access& a) { return a.resource == index && a.reads; });
  });
}

VkExtent3D PassContext::extent(std::string_view port) const {
  const ResourceDesc& d = descOf(graph_, bound_, port);
  return {d.width, d.height, d.depth};
}

uint32_t PassContext::layers(std::string_view port) const { return descOf(graph_, bound_, port).layers; }
uint64_t PassContext::count(std::string_view port) const { return descOf(graph_, bound_, port).count; }

int64_t PassContext::evaluate(const SizeExpr& expression) const {
  using Op = SizeExpr::Op;
  std::vector<int64_t> stack;
  for (const SizeExpr::Term& term : expression.terms()) {
    switch (term.op) {
      case Op::Constant:
        stack.push_back(term.constant);
        break;
      case Op::Parameter:
        stack.push_back(parameterNumber(bound_, term.name));
        break;
      case Op::PortWidth:
      case Op::PortHeight:
      case Op::PortLayers:
      case Op::PortCount:
        stack.push_back(has(term.name) ? sizeOf(term.op, descOf(graph_, bound_, term.name)) : 0);
        break;
      case Op::Wired:
        stack.push_back(has(term.name) ? 1 : 0);
        break;
      case Op::Read:
        stack.push_back(isRead(term.name) ? 1 : 0);
        break;
      case Op::ParameterIs:
        stack.push_back(parameters().text(term.name) == term.choice ? 1 : 0);
        break;
      case Op::ViewWidth:
      case Op::ViewHeight:
      case Op::Environment:
        throw Error(ExitCode::Internal,
                    fmt::format("a step of pass `{}` is over `{}`, which only sizes of ports know",
                                bound_.declaration->type, expression.print()));
      default: {
        const int64_t b = stack.back();
        stack.pop_back();
        stack.back() = apply(term.op, stack.back(), b);
      }
    }
  }
  return stack.back();
}

}  // namespace fovea::graph
