// The commands `fovea graphs` and `fovea describe`: which graphs there are, and what one of them does.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "framework/base/paths.h"
#include "framework/graph/report/json.h"
#include "framework/graph/report/report.h"
#include "framework/graph/report/traffic.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/author/graph_files.h"
#include "samples/fovea/author/rows.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

namespace fs = std::filesystem;

// ---- The list ----------------------------------------------------------------------------------------

std::string memberText(const json::Value& document, const char* key) {
  const json::Value* value = document.find(key);
  return value && value->isString() ? value->string : std::string();
}

// As much of a text as fits into a line.
std::string shortened(const std::string& text) {
  constexpr size_t kWidth = 100;
  if (text.size() <= kWidth) return text;
  const size_t space = text.rfind(' ', kWidth - 4);
  return text.substr(0, space == std::string::npos ? kWidth - 4 : space) + " ...";
}

ExitCode listGraphs(const std::vector<std::string>& given, bool asJson) {
  std::vector<fs::path> folders(given.begin(), given.end());
  for (const fs::path& folder : folders)
    if (!fs::is_directory(folder))
      throw Error(ExitCode::BadInput, fmt::format("`{}` is no folder", folder.string()),
                  "name a folder with graph files, or none for the stock graphs");
  if (folders.empty()) folders = dataFolders("graphs");
  nlohmann::json all = nlohmann::json::array();
  std::vector<TableRow> rows;
  for (const auto& [name, file] : graphFiles(folders)) {
    const json::Value merged = graph::loadMerged(file.string(), {{}, dataFolders("graphs")});
    const std::string description = memberText(merged, "description");
    rows.push_back({name, "", shortened(description)});
    const std::string base = memberText(json::parseFile(file), "extends");
    all.push_back({{"name", name},
                   {"file", file.string()},
                   {"description", description},
                   {"extends", base.empty() ? nlohmann::json(nullptr) : nlohmann::json(base)}});
  }
  if (asJson) {
    fmt::print("{}\n", all.dump(2));
    return ExitCode::Ok;
  }
  size_t width = 0;
  for (const TableRow& row : rows) width = std::max(width, row[0].size());
  for (const TableRow& row : rows) fmt::print("{:<{}}  {}\n", row[0], width, row[2]);
  return ExitCode::Ok;
}

// ---- One graph ---------------------------------------------------------------------------------------

struct DescribeOptions {
  GraphOptions graph;
  std::string size = "1024x1024";
  bool json = false;
};

void printPasses(const graph::Plan& plan) {
  const graph::BoundGraph& graph = *plan.graph;
  const std::vector<graph::PassTraffic> moved = graph::traffic(plan);
  const double pixels = double(std::max<uint64_t>(graph::outputPixels(graph), 1));
  std::vector<TableRow> rows;
  for (size_t l = 0; l < plan.levels.size(); ++l)
    for (const uint32_t p : plan.levels[l].passes)
      rows.push_back({fmt::format("{:>2} {}", l, graph.passes[p].name),
                      fmt::format("{:.0f}", double(moved[p].pictures.total()) / pixels),
                      graph.passes[p].declaration->doc});
  printRows("passes, by level: bytes of pictures that they move for a pixel", rows);
  std::vector<std::string> culled;
  for (size_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.passLive[p]) culled.push_back(graph.passes[p].name);
  if (!culled.empty()) fmt::print("  not needed with these values: {}\n", fmt::join(culled, ", "));
}

void printStory(const graph::Description& description, const graph::Environment& environment,
                const graph::Plan& plan, const std::string& size) {
  const graph::BoundGraph& graph = *plan.graph;
  fmt::print("{}\n  {}\n", graph.name, graph.description);
  std::vector<TableRow> parameters, strategies;
  for (const graph::Setting& setting : graph::settings(description, environment)) {
    const bool isStrategy = setting.spec.type == graph::ParameterSpec::Type::Choice;
    (isStrategy ? strategies : parameters)
        .push_back({setting.name, describeValue(setting.value, setting.spec),
                    fmt::format("{} -> {}", setting.spec.doc, fmt::join(setting.reaches, ", "))});
  }
  printRows("parameters: value (range), what it is -> what takes it", parameters);
  printRows("strategies: value (those that fit this graph), what it is -> what takes it", strategies);
  std::vector<TableRow> view;
  for (const graph::ParameterSpec& spec : graph::viewParameters())
    view.push_back(
        {"view." + spec.name, describeValue(printValue(*graph.view.find(spec.name)), spec), spec.doc});
  printRows("the frame", view);
  printPasses(plan);
  std::vector<TableRow> outputs;
  for (const graph::BoundOutput& o : graph.outputs)
    outputs.push_back({o.name, graph::describe(graph.resources[o.resource].desc), ""});
  printRows("outputs", outputs);
  fmt::print("\nmemory at {}: {} shared by what lives for a frame, {} kept\n", size,
             graph::printBytes(plan.bytesAliased), graph::printBytes(plan.bytesKept));
}

ExitCode describeGraph(const DescribeOptions& options) {
  Diagnostics messages;
  const graph::Description description = loadGraph(options.graph, messages);
  const graph::Environment environment =
      session::sceneEnvironment(nullptr, {}, {}, parseSize(options.size), options.graph.rays);
  auto bound = std::make_shared<const graph::BoundGraph>(graph::bind(description, environment, messages));
  const graph::Plan plan = graph::compile(bound);
  printWarnings(messages);
  if (options.json)
    fmt::print("{}\n", graph::graphJson(description, environment, plan).dump(2));
  else
    printStory(description, environment, plan, options.size);
  return ExitCode::Ok;
}

}  // namespace

std::map<std::string, fs::path> graphFiles(const std::vector<fs::path>& folders, bool parts) {
  std::map<std::string, fs::path> files;
  for (const fs::path& folder : folders) {
    std::error_code ec;
    for (fs::recursive_directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
      const fs::path& file = at->path();
      // Schemas and pass files have an ending of their own before that of JSON.
      if (file.extension() != ".json" || file.stem().has_extension()) continue;
      const fs::path name = file.lexically_relative(folder).replace_extension();
      if (parts || *name.begin() != "parts") files.emplace(name.string(), file);
    }
  }
  return files;
}

void addGraphs(CLI::App& program, Action& action) {
  CLI::App* list = program.add_subcommand("graphs", "List the graphs, with a line on each");
  auto folders = std::make_shared<std::vector<std::string>>();
  auto asJson = std::make_shared<bool>(false);
  list->add_option("FOLDER", *folders, "Folders with graph files; the stock graphs if none is given")
      ->type_name("");
  addJsonFlag(*list, *asJson);
  list->callback(
      [folders, asJson, &action] { action = [folders, asJson] { return listGraphs(*folders, *asJson); }; });

  CLI::App* describe = program.add_subcommand(
      "describe", "Tell what a graph does: parameters, strategies that fit, passes, memory");
  auto options = std::make_shared<DescribeOptions>();
  addGraphOptions(*describe, options->graph);
  describe->add_option("--size", options->size, "Picture size for memory and traffic; default 1024x1024")
      ->type_name("WxH");
  addJsonFlag(*describe, options->json);
  describe->callback([options, &action] { action = [options] { return describeGraph(*options); }; });
}

}  // namespace fovea::cli
