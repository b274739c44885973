// The command `fovea vr`: shows a graph in a headset.
#include <memory>

#include "framework/session/interrupt.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"
#include "samples/fovea/vr/application.h"

namespace fovea::cli {
namespace {

struct VrOptions {
  vr::Options vr;
  std::string size;
};

ExitCode runVr(VrOptions options) {
  if (!options.size.empty()) options.vr.size = parseSize(options.size);
  catchInterrupts();
  vr::Application application(options.vr);
  application.run();
  application.report();
  return ExitCode::Ok;
}

void addRoomOptions(CLI::App& command, vr::Options& options) {
  command.add_option("--scale", options.rig.scale, "Metres of the scene in a metre of the room; default 1")
      ->type_name("S")
      ->check(numberBetween(1e-3, 1e3));
  command
      .add_option(
          "--floor", options.rig.floor,
          "Height in the scene of the room's floor, metres; default: eyes begin at\nthe height of the "
          "scene's camera")
      ->type_name("Y")
      ->check(numberBetween(-1e6, 1e6));
  command
      .add_option("--fly-speed", options.rig.speed,
                  "Metres of the room a second with the thumbsticks pushed; default 1.5")
      ->type_name("V")
      ->check(numberBetween(0, 100));
  command.add_option("--speed", options.speed, "Seconds of the scene in a second; default 1, 0 stands still")
      ->type_name("F")
      ->check(numberBetween(0, 16));
}

void addFileOptions(CLI::App& command, vr::Options& options) {
  command
      .add_option("--record", options.record,
                  "Where head, eyes and gaze were in every frame, for `render --head-trace`")
      ->type_name("FILE.csv");
  command
      .add_option("--log", options.log,
                  "A row a frame: whether it came in time, the age of the gaze, and what\nrecording took")
      ->type_name("FILE.csv");
  command
      .add_option("--timings", options.timings,
                  "Times and counters of the passes and of each eye, .json or .csv")
      ->type_name("FILE");
}

}  // namespace

void addVr(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("vr", "Show a running graph in a headset, through OpenXR");
  auto options = std::make_shared<VrOptions>();
  vr::Options& vr = options->vr;
  addGraphOptions(*command, vr.graph);
  vr.graph.graph = "foveal_stereo_view";
  command->get_option("GRAPH")->required(false)->description(
      "Graph: a file, or the bare name of a stock graph for two eyes; default\nfoveal_stereo_view");
  command->add_option("--scene", vr.scene, "Scene: a .json, .gltf or .glb file, or a bare name (cornellbox)")
      ->required()
      ->type_name("SCENE");
  addFollowLinksOption(*command);
  addEnvironmentOption(*command, vr.environment);
  command->add_option("--size", options->size, "Pixels of each eye; default: what the headset recommends")
      ->type_name("WxH");
  command->add_option("--resolution", vr.resolution, "Factor on each side of the recommended size; default 1")
      ->type_name("F")
      ->check(numberBetween(0.05, 4));
  addRoomOptions(*command, vr);
  command
      ->add_option("--frames", vr.frames,
                   "Show so many frames, then end; default: until the headset or Ctrl-C ends it")
      ->type_name("N")
      ->transform(wholeNumberBetween(1, 1'000'000'000));
  command->add_option("--seed", vr.seed, "Seed of all random numbers; default 1")
      ->type_name("S")
      ->transform(wholeNumberBetween(0, UINT32_MAX));
  addFileOptions(*command, vr);
  addWithoutOption(*command, vr.without);
  addFrameLimitOption(*command, vr.frameLimit);
  command->add_flag("--validation", vr.validation, "Run under the Vulkan validation layers (slow)");
  command->callback([options, &action] { action = [options] { return runVr(*options); }; });
}

}  // namespace fovea::cli
