// The command `fovea passes`: lists every pass type, or describes one, from the declarations of the passes.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "fovea/error.h"
#include "framework/gpu/format.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/report/json.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/author/rows.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

using namespace graph;

std::string formatName(VkFormat format) {
  return format == VK_FORMAT_UNDEFINED ? "any float" : std::string(gpu::formatInfo(format).name);
}

// `sized`: whether to print sizes; outputs declare a size, while inputs take that of what is connected.
std::string describe(const ResourceSpec& r, bool sized) {
  if (r.kind == ResourceKind::Buffer)
    return sized ? fmt::format("buffer of {} {}", r.count.print(), r.element) : "buffer of " + r.element;
  std::string text = formatName(r.format) + (r.volume ? " volume" : r.array ? " image array" : " image");
  if (!sized) return text;
  text += fmt::format(", {} x {}", r.width.print(), r.height.print());
  if (r.volume) text += " x " + r.depth.print();
  if (r.array) text += fmt::format(", {} layers", r.layers.print());
  return text;
}

std::string lifetimeName(Lifetime lifetime) {
  switch (lifetime) {
    case Lifetime::Transient:
      return {};
    case Lifetime::View:
      return ", kept until a camera cut";
    case Lifetime::Scene:
      return ", kept with the scene";
  }
  return {};
}

std::vector<TableRow> portRows(const PassDeclaration& pass, Direction direction) {
  std::vector<TableRow> rows;
  for (const PortSpec& port : pass.ports) {
    if (port.direction != direction) continue;
    const bool sized = direction != Direction::Input;
    std::string suffix = port.optional ? ", optional" : "";
    suffix += lifetimeName(port.lifetime);
    if (port.bundle.empty()) {
      rows.push_back({port.name, describe(port.members.front().resource, sized) + suffix, port.doc});
      continue;
    }
    rows.push_back({port.name, "bundle " + port.bundle + suffix, port.doc});
    for (const MemberSpec& m : port.members)
      rows.push_back({"  ." + m.name, describe(m.resource, sized), m.doc});
  }
  return rows;
}

TableRow describe(const StepSpec& step) {
  const std::string condition = step.condition.print();
  return {step.name, step.shader, condition == "1" ? "" : "if " + condition};
}

ExitCode listTypes(bool asJson) {
  if (asJson) {
    nlohmann::json all = nlohmann::json::array();
    for (const std::string& type : Registry::global().types())
      all.push_back(passTypeJson(*Registry::global().find(type)));
    fmt::print("{}\n", all.dump(2));
    return ExitCode::Ok;
  }
  size_t width = 0;
  for (const std::string& type : Registry::global().types()) width = std::max(width, type.size());
  for (const std::string& type : Registry::global().types())
    fmt::print("{:<{}}  {}\n", type, width, Registry::global().find(type)->doc);
  return ExitCode::Ok;
}

ExitCode showType(const std::string& type, bool asJson) {
  const PassDeclaration* pass = Registry::global().find(type);
  if (!pass) {
    const std::string nearest = nearestName(type, Registry::global().types());
    throw Error(ExitCode::BadInput, "there is no pass type `" + type + "`",
                nearest.empty() ? "`fovea passes` lists them" : "did you mean `" + nearest + "`?");
  }
  if (asJson) {
    fmt::print("{}\n", passTypeJson(*pass).dump(2));
    return ExitCode::Ok;
  }
  fmt::print(
      "{} ({}{}{})\n  {}\n", pass->type, pass->kind == PassKind::Host ? "on the CPU" : nameOf(pass->kind),
      pass->usesView ? ", looks through a view" : "", pass->sideEffects ? ", never culled" : "", pass->doc);
  printRows("inputs", portRows(*pass, Direction::Input));
  printRows("updated in place", portRows(*pass, Direction::InOut));
  printRows("outputs", portRows(*pass, Direction::Output));
  printRows("scratch memory", portRows(*pass, Direction::Scratch));
  std::vector<TableRow> rows;
  for (const ParameterSpec& p : pass->parameters)
    rows.push_back({p.name, describeValue(printValue(p.defaultValue), p), p.doc});
  printRows("parameters: default (range)", rows);
  rows.clear();
  for (const CounterSpec& c : pass->counters) rows.push_back({c.name, "", c.doc});
  printRows("counters", rows);
  rows.clear();
  for (const RequirementSpec& r : pass->requirements) rows.push_back({"", r.condition.print(), r.message});
  printRows("requirements: condition, and what is wrong without it", rows);
  rows.clear();
  for (const StepSpec& step : pass->steps) rows.push_back(describe(step));
  printRows("steps", rows);
  return ExitCode::Ok;
}

struct PassesOptions {
  std::string type;
  std::vector<std::string> plugins, folders;
  bool json = false;
};

}  // namespace

void addPasses(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("passes", "List the pass types, or show all about one");
  auto options = std::make_shared<PassesOptions>();
  command->add_option("TYPE", options->type, "Show this type's ports, parameters and counters")
      ->type_name("");
  addJsonFlag(*command, options->json);
  addPluginOption(*command, options->plugins);
  addPassesOption(*command, options->folders);
  command->callback([options, &action] {
    action = [options] {
      loadPlugins(options->plugins);
      loadPassFolders(options->folders);
      return options->type.empty() ? listTypes(options->json) : showType(options->type, options->json);
    };
  });
}

}  // namespace fovea::cli
