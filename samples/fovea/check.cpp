// fovea check: is a graph right, and what plan comes out of it. Needs no device and no scene.
#include <fmt/format.h>

#include <memory>

#include "framework/graph/compile.h"
#include "framework/graph/execute.h"
#include "framework/graph/report.h"
#include "framework/scene/scene.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

struct CheckOptions {
  GraphOptions graph;
  std::string plan, size = "1024x1024";
};

ExitCode check(const CheckOptions& options) {
  const glm::uvec2 size = parseSize(options.size);
  Diagnostics messages;
  const graph::Description description = loadGraph(options.graph, messages);
  auto bound = std::make_shared<const graph::BoundGraph>(graph::bind(
      description, graph::sceneEnvironment(nullptr, {}, {}, graph::frameViews({size.x, size.y})), messages));
  const graph::Plan plan = graph::compile(bound);
  graph::warnAboutPlan(plan, messages);
  printWarnings(messages);
  if (options.plan == "text") {
    fmt::print("{}", graph::planText(plan));
  } else if (options.plan == "dot") {
    fmt::print("{}", graph::planDot(plan));
  } else if (options.plan == "json") {
    fmt::print("{}", graph::planJson(plan));
  } else {
    size_t live = 0;
    for (const uint8_t l : plan.passLive) live += l;
    std::vector<std::string> outputs;
    for (const graph::BoundOutput& output : bound->outputs) outputs.push_back(output.name);
    fmt::print("graph `{}` is right: {} passes ({} run), outputs {}\n", bound->name, bound->passes.size(),
               live, quoteList(outputs));
  }
  return ExitCode::Ok;
}

}  // namespace

void addCheck(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("check", "Check a graph and show its plan; needs no device");
  auto options = std::make_shared<CheckOptions>();
  addGraphOptions(*command, options->graph);
  command->add_option("--plan", options->plan, "Print order, barriers and memory as text, dot or json")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"text", "dot", "json"}));
  command->add_option("--size", options->size, "Picture size the plan is for; default 1024x1024")
      ->type_name("WxH");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace fovea::cli
