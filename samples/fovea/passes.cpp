// The command `fovea passes`: lists every pass type, or describes one, from the declarations of the passes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "fovea/error.h"
#include "framework/gpu/format.h"
#include "framework/graph/pass/registry.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

using namespace graph;

// Name, properties, doc; printed in columns.
using PassRow = std::array<std::string, 3>;

void printRows(const std::string& title, const std::vector<PassRow>& rows) {
  if (rows.empty()) return;
  fmt::print("\n{}\n", title);
  size_t name = 0, properties = 0;
  for (const PassRow& row : rows) {
    name = std::max(name, row[0].size());
    if (row[1].size() <= 44) properties = std::max(properties, row[1].size());
  }
  for (const PassRow& row : rows) {
    std::string text = fmt::format("  {:<{}}  {:<{}}  {}", row[0], name, row[1], properties, row[2]);
    text.erase(text.find_last_not_of(' ') + 1);
    fmt::print("{}\n", text);
  }
}

std::string kindName(PassKind kind) {
  switch (kind) {
    case PassKind::Compute:
      return "compute";
    case PassKind::Graphics:
      return "graphics";
    case PassKind::ComputeAndGraphics:
      return "compute and graphics";
    case PassKind::Host:
      return "on the CPU";
  }
  return {};
}

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

std::vector<PassRow> portRows(const PassDeclaration& pass, Direction direction) {
  std::vector<PassRow> rows;
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

std::string formatValue(const Value& value) {
  if (const bool* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const int64_t* i = std::get_if<int64_t>(&value)) return std::to_string(*i);
  if (const double* d = std::get_if<double>(&value)) return fmt::format("{:g}", *d);
  const std::string& text = std::get<std::string>(value);
  return text.empty() ? "\"\"" : text;
}

std::string describe(const ParameterSpec& p) {
  using Type = ParameterSpec::Type;
  std::string text = formatValue(p.defaultValue);
  if (!p.unit.empty()) text += ' ' + p.unit;
  if (p.type == Type::Bool) return text + " (true or false)";
  if (p.type == Type::Text) return text + " (text)";
  if (p.type == Type::Choice) return fmt::format("{} (one of {})", text, fmt::join(p.choices, ", "));
  if (!std::isfinite(p.min) && !std::isfinite(p.max)) return text;
  const char* whole = p.type == Type::Int ? "whole, " : "";
  if (!std::isfinite(p.max)) return fmt::format("{} ({}from {:g})", text, whole, p.min);
  if (!std::isfinite(p.min)) return fmt::format("{} ({}up to {:g})", text, whole, p.max);
  return p.type == Type::Int ? fmt::format("{} ({:.0f} to {:.0f}, whole)", text, p.min, p.max)
                             : fmt::format("{} ({:g} to {:g})", text, p.min, p.max);
}

PassRow describe(const StepSpec& step) {
  const std::string condition = step.condition.print();
  return {step.name, step.shader, condition == "1" ? "" : "if " + condition};
}

ExitCode listTypes() {
  size_t width = 0;
  for (const std::string& type : Registry::global().types()) width = std::max(width, type.size());
  for (const std::string& type : Registry::global().types())
    fmt::print("{:<{}}  {}\n", type, width, Registry::global().find(type)->doc);
  return ExitCode::Ok;
}

ExitCode showType(const std::string& type) {
  const PassDeclaration* pass = Registry::global().find(type);
  if (!pass) {
    const std::string nearest = nearestName(type, Registry::global().types());
    throw Error(ExitCode::BadInput, "there is no pass type `" + type + "`",
                nearest.empty() ? "`fovea passes` lists them" : "did you mean `" + nearest + "`?");
  }
  fmt::print("{} ({}{}{})\n  {}\n", pass->type, kindName(pass->kind),
             pass->usesView ? ", looks through a view" : "", pass->sideEffects ? ", never culled" : "",
             pass->doc);
  printRows("inputs", portRows(*pass, Direction::Input));
  printRows("updated in place", portRows(*pass, Direction::InOut));
  printRows("outputs", portRows(*pass, Direction::Output));
  printRows("scratch memory", portRows(*pass, Direction::Scratch));
  std::vector<PassRow> rows;
  for (const ParameterSpec& p : pass->parameters) rows.push_back({p.name, describe(p), p.doc});
  printRows("parameters: default (range)", rows);
  rows.clear();
  for (const CounterSpec& c : pass->counters) rows.push_back({c.name, "", c.doc});
  printRows("counters", rows);
  rows.clear();
  for (const StepSpec& step : pass->steps) rows.push_back(describe(step));
  printRows("steps", rows);
  return ExitCode::Ok;
}

struct PassesOptions {
  std::string type;
  std::vector<std::string> plugins, folders;
};

}  // namespace

void addPasses(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("passes", "List the pass types, or show all about one");
  auto options = std::make_shared<PassesOptions>();
  command->add_option("TYPE", options->type, "Show this type's ports, parameters and counters")
      ->type_name("");
  addPluginOption(*command, options->plugins);
  addPassesOption(*command, options->folders);
  command->callback([options, &action] {
    action = [options] {
      loadPlugins(options->plugins);
      loadPassFolders(options->folders);
      return options->type.empty() ? listTypes() : showType(options->type);
    };
  });
}

}  // namespace fovea::cli
