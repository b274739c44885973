// The command `fovea check`: whether a graph is valid, and the plan that results. It needs no device and no scene.
#include <fmt/format.h>

#include <memory>

#include "framework/base/json.h"
#include "framework/base/paths.h"
#include "framework/gpu/shader/disk_cache.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/edit/strict.h"
#include "framework/graph/report/report.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

struct CheckOptions {
  GraphOptions graph;
  std::string plan, size = "1024x1024";
  bool merged = false, strict = false;
};

// Whatever has no effect in the file is an error, so that automated checks can refuse it.
void refuseWarnings(const CheckOptions& options, Diagnostics messages) {
  const std::vector<std::filesystem::path> folders = dataFolders("graphs");
  const std::filesystem::path file = graph::findGraph(options.graph.graph, folders);
  graph::warnAboutRepetition(file, {{}, folders}, messages);
  std::vector<Diagnostic> errors = messages.list();
  std::erase_if(errors, [&](const Diagnostic& d) {  // what the files that it extends say is not its own
    return d.where.line > 0 && d.where.file != file.string();
  });
  if (errors.empty()) return;
  for (Diagnostic& d : errors) d.severity = Severity::Error;
  throw Error(ExitCode::BadInput, std::move(errors));
}

ExitCode check(const CheckOptions& options) {
  if (options.merged && !options.graph.set.empty())
    throw Error(ExitCode::Usage, "--merged prints the files' own values and takes no --set",
                "leave out one of them; a graph file of one's own may hold the values in its `parameters`");
  const glm::uvec2 size = parseSize(options.size);
  Diagnostics messages;
  const graph::Description description = loadGraph(options.graph, messages);
  auto bound = std::make_shared<const graph::BoundGraph>(graph::bind(
      description, session::sceneEnvironment(nullptr, {}, {}, size, options.graph.rays), messages));
  gpu::ShaderCompiler compiler(gpu::defaultCacheDirectory());
  graph::addShaderFolders(compiler, graph::Registry::global());
  graph::CompileOptions compileOptions;
  compileOptions.shaders = [&](const std::string& file, const gpu::Defines& defines) {
    return compiler.compile(file, defines);
  };
  const graph::Plan plan = graph::compile(bound, compileOptions);
  graph::warnAboutPlan(plan, messages);
  if (options.strict) refuseWarnings(options, messages);
  printWarnings(messages);
  if (options.merged) {
    fmt::print("{}", json::print(graph::loadMerged(options.graph.graph, {{}, dataFolders("graphs")})));
  } else if (options.plan == "text") {
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
    fmt::print("graph `{}` is valid: {} passes ({} run), outputs {}\n", bound->name, bound->passes.size(),
               live, quoteList(outputs));
  }
  return ExitCode::Ok;
}

}  // namespace

void addCheck(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("check", "Check a graph and show its plan; needs no device");
  auto options = std::make_shared<CheckOptions>();
  addGraphOptions(*command, options->graph);
  CLI::Option* plan =
      command->add_option("--plan", options->plan, "Print order, barriers and memory as text, dot or json")
          ->type_name("FORMAT")
          ->check(CLI::IsMember({"text", "dot", "json"}));
  command
      ->add_flag("--merged", options->merged, "Print the graph with all that it extends merged in, as JSON")
      ->excludes(plan);
  command->add_flag("--strict", options->strict,
                    "Refuse what the graph says in vain: parameters that nothing uses, passes that\nnothing "
                    "needs, values that it inherits as well");
  command->add_option("--size", options->size, "Picture size the plan is for; default 1024x1024")
      ->type_name("WxH");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace fovea::cli
