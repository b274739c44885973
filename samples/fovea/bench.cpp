// The command `fovea bench`: options of a suite of measurements, and of measuring the passes of one graph.
#include "benchmarks/runner/bench.h"

#include <memory>

#include "benchmarks/runner/passes.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {

namespace {

void addSuiteOptions(CLI::App& command, bench::SuiteOptions& options) {
  command
      .add_option("SUITE", options.suite,
                  "Suite: a .json file, or a bare name (quick, paper, ..); or `passes` with --graph")
      ->type_name("");
  command
      .add_option("-o,--output", options.folder,
                  "Folder of results, pictures, tables and report; may be shared")
      ->type_name("DIR");
  command
      .add_option("--cache", options.cache,
                  "Folder of path-traced references, for several suites to share; default: the\n"
                  "environment variable FOVEA_BENCH_CACHE, else references/ in the folder of -o")
      ->type_name("DIR");
  command.add_flag("--references-only", options.referencesOnly,
                   "Only render the references that are missing, for a run at another time");
  command
      .add_option("--only", options.only, "Only jobs whose name matches (*, ?, [ab], [!ab]) or contains this")
      ->type_name("GLOB");
  command
      .add_option("--shard", options.shard,
                  "Only the I-th of N parts of the jobs, for job arrays; DIR is shared")
      ->type_name("I/N");
  command.add_flag("--resume", options.resume,
                   "Go on in DIR, which must exist; without it, too, what is done is not done again");
  command.add_flag(
      "--replace", options.replace,
      "Measure anew what was measured with other code, device or parameters,\ninstead of refusing to go on");
  command.add_flag("--report", options.report, "Only tables and report, from the results that are there");
  command.add_flag(
      "--serve", options.serve,
      "Measure the jobs whose names arrive on standard input, one a line, and answer each with a\n"
      "line when its result is written; for programs that spread a suite over machines");
  command.add_flag("--list", options.list, "Print the names of the jobs and stop");
  addList(command, "--scene", options.scenes,
          "Scene instead of those of the suite: a file, a bare name, or a folder with a slash\n"
          "(mine/), which stands for the scene files (.json) in it; may be repeated")
      ->type_name("SCENE");
  command
      .add_option(
          "--scale", options.scale,
          "One of the scales of the suite, such as `small` of `paper`: other sizes and\namounts of work")
      ->type_name("NAME");
  command.add_option("--size", options.size, "Picture size instead of the suite's, where that does not vary")
      ->type_name("WxH");
  command.add_option("--seeds", options.seeds, "Seeds instead of the suite's number of them")
      ->type_name("N")
      ->transform(wholeNumberBetween(1, 1000));
  addFollowLinksOption(command);
  addDeviceOptions(command, options.device, options.without);
  addFrameLimitOption(command, options.frameLimit);
  addPluginOption(command, options.plugins);
  command.add_flag("-q,--quiet", options.quiet, "Print nothing but warnings and errors");
}

void addPassBenchOptions(CLI::App& command, bench::PassBenchOptions& options) {
  const std::string group = "Passes of one graph (fovea bench passes --graph ..; -o then names a .json file)";
  command.add_option("--graph", options.graph, "Graph: a file or a bare name; --scene names the scene")
      ->type_name("GRAPH")
      ->group(group);
  addList(command, "--set", options.set, "Override a parameter, as in `fovea render`")
      ->type_name("NAME=VALUE")
      ->group(group);
  const auto count = [&](const char* name, uint32_t& value, uint32_t min, const char* doc) {
    command.add_option(name, value, doc)
        ->type_name("N")
        ->transform(wholeNumberBetween(min, 1'000'000))
        ->group(group);
  };
  count("--frames", options.frames, 1, "Frames measured in each repeat; default 5");
  count("--warmup", options.warmup, 0, "Frames before them; default 3");
  count("--first", options.first, 0, "Number of the first frame, warm-up included; default 0");
  count("--repeats", options.repeats, 1, "Times that all is set up and measured anew; default 5");
  command
      .add_option("--baseline", options.baseline,
                  "Compare with a file that -o wrote, or with another build of this program, whose\nrepeats "
                  "alternate with ours; exit code 8 when a pass became slower beyond the noise")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option("--threshold", options.threshold,
                  "Changes up to so many percent are not worth a word; default 2")
      ->type_name("P")
      ->check(numberBetween(0, 1000))
      ->group(group);
  command.add_flag("--json", options.json, "Print every frame's times as JSON")->group(group);
}

}  // namespace

void addBench(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "bench",
      "Run a suite of measurements to tables and a report, measure the passes of a graph, or (fovea bench\n"
      "model) say how fast a device could run them");
  auto options = std::make_shared<bench::SuiteOptions>();
  auto passes = std::make_shared<bench::PassBenchOptions>();
  addSuiteOptions(*command, *options);
  addPassBenchOptions(*command, *passes);
  addBenchModel(*command, action);
  command->callback([command, options, passes, &action] {
    if (!command->get_subcommands().empty()) return;
    if (options->suite.empty()) throw CLI::RequiredError("SUITE");
    action = [options, passes] {
      if (passes->graph.empty()) return bench::runSuite(*options);
      if (options->suite != "passes")
        throw Error(ExitCode::Usage,
                    "--graph belongs to `fovea bench passes`; a suite names its graphs itself");
      if (options->scenes.size() != 1)
        throw Error(ExitCode::Usage, "`fovea bench passes` needs one --scene", "e.g. --scene cornellbox");
      passes->scene = options->scenes.front();
      passes->output = options->folder, passes->size = options->size, passes->device = options->device;
      passes->without = options->without, passes->frameLimit = options->frameLimit;
      passes->plugins = options->plugins, passes->quiet = options->quiet;
      return bench::benchPasses(*passes);
    };
  });
}

}  // namespace fovea::cli
