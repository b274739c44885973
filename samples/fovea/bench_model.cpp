// The command `fovea bench model`: the least time that a device needs for the passes of a graph, beside that measured.
#include <memory>

#include "benchmarks/runner/model/model.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {

namespace {

void addRateOptions(CLI::App& command, bench::ModelOptions& options) {
  command
      .add_option("--kind", options.kind,
                  "Kind of device that the bounds are for: headset (the default), laptop, desktop or cpu")
      ->type_name("KIND");
  const auto rate = [&](const char* name, std::optional<double>& value, const char* unit, const char* doc) {
    command.add_option(name, value, doc)->type_name(unit)->check(numberBetween(1e-6, 1e9));
  };
  rate("--bandwidth", options.bandwidth, "GB/s", "Bandwidth of its memory, instead of the kind's");
  rate("--flops", options.flops, "TFLOP/s", "Its operations of single precision, instead of the kind's");
  rate("--ray-rate", options.rayRate, "GRAYS/s", "Rays that it traces, instead of the kind's");
}

void addFrameOptions(CLI::App& command, bench::ModelOptions& options) {
  command.add_option("--size", options.size, "Picture size; default 1024x1024")->type_name("WxH");
  const auto count = [&](const char* name, uint32_t& value, int64_t min, int64_t max, const char* doc) {
    command.add_option(name, value, doc)->type_name("N")->transform(wholeNumberBetween(min, max));
  };
  count("--frames", options.frames, 1, 1'000'000, "Frames measured; default 5");
  count("--warmup", options.warmup, 0, 1'000'000, "Frames before them; default 3");
  count("--first", options.first, 0, 1'000'000, "Number of the first frame, warm-up included; default 0");
  count("--seed", options.seed, 0, UINT32_MAX, "Seed of all random numbers; default 1");
}

}  // namespace

void addBenchModel(CLI::App& benchCommand, Action& action) {
  CLI::App* command = benchCommand.add_subcommand(
      "model",
      "The least time that a device of some kind needs for each pass of a graph, beside that measured");
  auto options = std::make_shared<bench::ModelOptions>();
  addGraphOptions(*command, options->graph);
  command
      ->add_option("--scene", options->scene,
                   "Scene: a .json, .gltf or .glb file, or a bare name (cornellbox)")
      ->required()
      ->type_name("SCENE");
  addRateOptions(*command, *options);
  addFrameOptions(*command, *options);
  command->add_option("--json", options->json, "Also write everything as JSON")->type_name("FILE");
  addFollowLinksOption(*command);
  addDeviceOptions(*command, options->device, options->without);
  addFrameLimitOption(*command, options->frameLimit);
  command->add_flag("-q,--quiet", options->quiet, "Print nothing but warnings and errors");
  command->callback([options, &action] { action = [options] { return bench::benchModel(*options); }; });
}

}  // namespace fovea::cli
