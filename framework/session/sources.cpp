#include "framework/session/sources.h"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "fovea/error.h"

namespace fovea::session {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& word,
                         const std::vector<std::string>& names) {
  const std::string nearest = nearestName(word, names);
  throw Error(ExitCode::BadInput, what, nearest.empty() ? "" : fmt::format("did you mean `{}`?", nearest));
}

void checkShown(const graph::Plan& plan, const graph::BoundPass& pass, const graph::Access& access,
                const SourceName& name) {
  const graph::BoundResource& resource = plan.graph->resources[access.resource];
  if (!plan.resourceLive[access.resource])
    throw Error(ExitCode::BadInput,
                fmt::format("`{}` of pass `{}` is not made: nothing needs it", name.path, pass.name),
                "wire it to a pass or name it in \"outputs\"");
  const bool image = resource.desc.kind == graph::ResourceKind::Image;
  if (image && (name.mip >= resource.desc.mips ||
                name.layer >= std::max(resource.desc.layers, std::max(1u, resource.desc.depth >> name.mip))))
    throw Error(ExitCode::BadInput, fmt::format("`{}` of pass `{}` has no mip {} of layer {}", name.path,
                                                pass.name, name.mip, name.layer));
}

graph::Observation findOutput(const graph::Plan& plan, const std::string& output) {
  const graph::BoundGraph& graph = *plan.graph;
  std::vector<std::string> names;
  for (const graph::BoundOutput& o : graph.outputs) {
    if (o.name == output) return findSource(plan, sourceOfOutput(graph, o));
    names.push_back(o.name);
  }
  refuse(fmt::format("the graph has no output `{}`", output), output, names);
}

}  // namespace

SourceName parseSource(std::string_view text) {
  SourceName name;
  const size_t at = text.find('@');
  if (at != std::string_view::npos) {
    const std::string_view part = text.substr(at + 1);
    const char* end = part.data() + part.size();
    const auto [rest, error] = std::from_chars(part.data(), end, name.mip);
    if (error == std::errc() && rest != end && *rest == '.') std::from_chars(rest + 1, end, name.layer);
    text = text.substr(0, at);
  }
  const size_t colon = text.find(':');
  if (colon != std::string_view::npos) name.pass = text.substr(0, colon);
  name.path = colon != std::string_view::npos ? text.substr(colon + 1) : text;
  return name;
}

std::string portPath(const graph::BoundPass& pass, const graph::Access& access) {
  const graph::PortSpec& port = pass.declaration->ports[access.port];
  return graph::memberPath(port, port.members[access.member]);
}

std::string sourceName(const graph::BoundPass& pass, const graph::Access& access) {
  return fmt::format("{}:{}", pass.name, portPath(pass, access));
}

std::string sourceOfOutput(const graph::BoundGraph& graph, const graph::BoundOutput& output) {
  for (const graph::BoundPass& pass : graph.passes)
    for (const graph::Access& access : pass.accesses)
      if (access.writes && access.resource == output.resource && access.version == output.version)
        return sourceName(pass, access);
  return {};
}

graph::Observation findSource(const graph::Plan& plan, const std::string& source) {
  const graph::BoundGraph& graph = *plan.graph;
  const SourceName name = parseSource(source);
  if (name.pass.empty()) {
    graph::Observation found = findOutput(plan, name.path);
    found.name = source;
    return found;
  }
  std::vector<std::string> names;
  for (uint32_t p = 0; p < graph.passes.size(); ++p) {
    const graph::BoundPass& pass = graph.passes[p];
    names.push_back(pass.name);
    if (pass.name != name.pass) continue;
    if (!plan.passLive[p])
      throw Error(ExitCode::BadInput,
                  fmt::format("pass `{}` does not run: nothing needs what it makes", pass.name),
                  "wire one of its outputs");
    std::vector<std::string> paths;
    for (uint32_t a = 0; a < pass.accesses.size(); ++a) {
      paths.push_back(portPath(pass, pass.accesses[a]));
      if (paths.back() != name.path) continue;
      checkShown(plan, pass, pass.accesses[a], name);
      return {source, p, a, name.mip, name.layer};
    }
    refuse(fmt::format("pass `{}` has no wired port `{}`", pass.name, name.path), name.path, paths);
  }
  refuse(fmt::format("the graph has no pass `{}`", name.pass), name.pass, names);
}

}  // namespace fovea::session
