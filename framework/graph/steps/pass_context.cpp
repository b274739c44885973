// What a bound pass knows about its place in the graph.
#include <fmt/format.h>

#include <algorithm>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/graph/compile/bound.h"
#include "framework/graph/pass/evaluate.h"

namespace fovea::graph {
namespace {

// Compares without making a string, since passes look up their ports in every frame.
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

}  // namespace

uint32_t accessOf(const BoundPass& pass, std::string_view path) {
  for (uint32_t i = 0; i < pass.accesses.size(); ++i) {
    const PortSpec& port = pass.declaration->ports[pass.accesses[i].port];
    if (isPath(port, port.members[pass.accesses[i].member], path)) return i;
  }
  const std::string nearest = nearestName(path, wiredPaths(pass));
  throw Error(ExitCode::Internal,
              fmt::format("pass `{}` ({}) asks for `{}`, which is not one of its wired ports", pass.name,
                          pass.declaration->type, path),
              nearest.empty() ? "" : fmt::format("did you mean `{}`?", nearest));
}

std::vector<std::string> wiredPaths(const BoundPass& pass) {
  std::vector<std::string> paths;
  for (const Access& a : pass.accesses) {
    const PortSpec& port = pass.declaration->ports[a.port];
    paths.push_back(memberPath(port, port.members[a.member]));
  }
  return paths;
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
uint32_t PassContext::mips(std::string_view port) const { return descOf(graph_, bound_, port).mips; }
const ResourceDesc& PassContext::desc(std::string_view port) const { return descOf(graph_, bound_, port); }
uint64_t PassContext::count(std::string_view port) const { return descOf(graph_, bound_, port).count; }

int64_t PassContext::evaluate(const SizeExpr& expression) const {
  using Op = SizeExpr::Op;
  std::string why = "is over something that only sizes of ports know";
  const auto leaf = [&](const SizeExpr::Term& term) -> std::optional<int64_t> {
    switch (term.op) {
      case Op::Constant:
        return term.constant;
      case Op::Parameter:
        return wholeNumber(bound_.parameters, term.name);
      case Op::PortWidth:
      case Op::PortHeight:
      case Op::PortLayers:
      case Op::PortCount:
        return has(term.name) ? quantityOf(descOf(graph_, bound_, term.name), term.op) : 0;
      case Op::Wired:
        return has(term.name);
      case Op::Read:
        return isRead(term.name);
      case Op::ParameterIs:
        return parameters().text(term.name) == term.choice;
      default:
        return std::nullopt;  // refused when the pass was registered
    }
  };
  if (const std::optional<int64_t> value = graph::evaluate(expression, why, leaf)) return *value;
  throw Error(ExitCode::BadInput, fmt::format("pass `{}` ({}): `{}` in one of its steps {}", bound_.name,
                                              bound_.declaration->type, expression.print(), why));
}

}  // namespace fovea::graph
