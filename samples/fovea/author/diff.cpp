// The command `fovea diff`: what differs in meaning between two graphs, or by numbers between two pictures.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "fovea/image.h"
#include "framework/graph/edit/diff.h"
#include "framework/image/flip.h"
#include "framework/scene/scene.h"
#include "framework/session/compared.h"
#include "framework/session/graph_run.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

struct DiffOptions {
  GraphOptions graph;  // with the first graph; its other options go for both
  std::string other, size = "1024x1024";
  bool check = false;
};

bool isPictureFile(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  return std::ranges::count(image::writableExtensions(), extension) > 0;
}

graph::Plan planOf(const DiffOptions& options, const std::string& name) {
  GraphOptions given = options.graph;
  given.graph = name;
  Diagnostics messages;
  const graph::Description description = loadGraph(given, messages);
  auto bound = std::make_shared<const graph::BoundGraph>(
      graph::bind(description,
                  session::sceneEnvironment(nullptr, {}, {}, parseSize(options.size), given.rays), messages));
  printWarnings(messages);
  return graph::compile(bound);
}

std::vector<std::string> pictureDifferences(const DiffOptions& options) {
  const Compared c = loadCompared(options.graph.graph, options.other, {}, {});
  const image::Measures m =
      image::compare(c.image, c.reference, c.halves, c.fovea, image::kDefaultPixelsPerDegree).whole;
  if (m.mse == 0) return {};
  return {fmt::format("MSE {}, PSNR {} dB, relMSE {}, FLIP {}", formatMeasure(m.mse), formatMeasure(m.psnr),
                      formatMeasure(m.relMse), formatMeasure(m.flip))};
}

ExitCode diff(const DiffOptions& options) {
  const bool pictures = isPictureFile(options.graph.graph) && isPictureFile(options.other);
  const std::vector<std::string> lines =
      pictures ? pictureDifferences(options)
               : graph::differences(planOf(options, options.graph.graph), planOf(options, options.other));
  for (const std::string& line : lines) fmt::print("{}\n", line);
  return options.check && !lines.empty() ? ExitCode::BadInput : ExitCode::Ok;
}

}  // namespace

void addDiff(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "diff", "Say what differs in meaning between two graphs, or how far two pictures are apart");
  auto options = std::make_shared<DiffOptions>();
  command->add_option("BEFORE", options->graph.graph, "A graph, or a picture (.exr, .pfm, .png)")
      ->required()
      ->type_name("");
  command->add_option("AFTER", options->other, "What to compare with it")->required()->type_name("");
  addList(*command, "--set", options->graph.set, "Override a parameter of both graphs")
      ->type_name("NAME=VALUE");
  addPluginOption(*command, options->graph.plugins);
  addPassesOption(*command, options->graph.passes);
  command->add_option("--size", options->size, "Picture size that plans are for; default 1024x1024")
      ->type_name("WxH");
  command->add_flag("--check", options->check, "End with exit code 3 if anything differs");
  command->callback([options, &action] { action = [options] { return diff(*options); }; });
}

}  // namespace fovea::cli
