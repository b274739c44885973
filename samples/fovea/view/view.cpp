// The command `fovea view`: shows a running graph in a browser.
#include <malloc.h>

#include <memory>
#include <optional>

#include "framework/session/interrupt.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"
#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/http/request.h"
#include "samples/fovea/view/http/server.h"
#include "samples/fovea/view/resume.h"
#include "samples/fovea/view/viewer.h"

namespace fovea::cli {
namespace {

struct ViewOptions {
  view::Viewer::Options viewer;
  std::string size = "512x512", host = "127.0.0.1";
  uint16_t port = 0;
};

// Runs until the end, or returns where a new process goes on.
std::optional<view::Resume> runOnce(const ViewOptions& options) {
  const std::optional<view::Resume>& resumed = options.viewer.resume;
  view::Exchange exchange;
  const view::Server server(exchange, options.host, resumed ? resumed->port : options.port,
                            resumed ? resumed->token : view::makeToken());
  const struct Stop {
    view::Exchange& exchange;
    ~Stop() { exchange.stop(); }
  } stop{exchange};
  view::Viewer viewer(exchange, options.viewer);
  std::printf("open %s\n", server.address().c_str());  // when there is something to see
  std::fflush(stdout);
  if (!viewer.run()) return std::nullopt;
  view::Resume next = viewer.resume();
  next.port = server.port();
  next.token = server.token();
  return next;
}

ExitCode runView(ViewOptions options) {
  view::Settings& settings = options.viewer.settings;
  settings.size = parseSize(options.size);
  options.viewer.resume = view::takeResume();
  if (const auto& resumed = options.viewer.resume) {
    settings.graph.graph = resumed->graph;
    settings.graph.set = resumed->set;
    settings.scene = resumed->scene;
    settings.size = {resumed->width, resumed->height};
    settings.seed = resumed->seed;
  }
  // Pictures are large, and many threads make them. Each in an arena of its own would keep the memory of some.
  mallopt(M_ARENA_MAX, 2);
  catchInterrupts();
  if (const std::optional<view::Resume> next = runOnce(options)) view::startAnew(*next);
  return ExitCode::Ok;
}

}  // namespace

void addView(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("view", "Show a running graph in a browser, and change it");
  auto options = std::make_shared<ViewOptions>();
  view::Settings& settings = options->viewer.settings;
  addGraphOptions(*command, settings.graph);
  settings.graph.graph = "foveal_view";
  command->get_option("GRAPH")->required(false)->description(
      "Graph: a file, or the bare name of a stock graph; default foveal_view");
  command
      ->add_option("--scene", settings.scene,
                   "Scene: a .json, .gltf or .glb file, or a bare name (cornellbox)")
      ->required()
      ->type_name("SCENE");
  addFollowLinksOption(*command);
  addEnvironmentOption(*command, settings.environment);
  command->add_option("--size", options->size, "Picture size; default 512x512")->type_name("WxH");
  command->add_option("--seed", settings.seed, "Seed of all random numbers; default 1")
      ->type_name("S")
      ->transform(wholeNumberBetween(0, UINT32_MAX));
  command
      ->add_option("--frames", options->viewer.frames,
                   "Render so many frames, whether somebody looks or not, and freeze")
      ->type_name("N")
      ->transform(wholeNumberBetween(1, 10'000'000));
  command
      ->add_option(
          "--host", options->host,
          "Name or address of this machine to listen on; default 127.0.0.1, which\nonly this machine "
          "reaches (elsewhere use `ssh -L PORT:127.0.0.1:PORT`)")
      ->type_name("HOST");
  command->add_option("--port", options->port, "Port to listen on; default 0, any free one")
      ->type_name("P")
      ->transform(wholeNumberBetween(0, UINT16_MAX));
  command
      ->add_option("--tev", options->viewer.tev,
                   "Send a picture of every frame to the image viewer tev, which listens there")
      ->type_name("HOST:PORT");
  addDeviceOptions(*command, options->viewer.device, options->viewer.without);
  addFrameLimitOption(*command, options->viewer.frameLimit);
  command->add_flag("--validation", options->viewer.validation,
                    "Run under the Vulkan validation layers (slow)");
  command->callback([options, &action] { action = [options] { return runView(*options); }; });
}

}  // namespace fovea::cli
