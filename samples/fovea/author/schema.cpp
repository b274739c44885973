// The command `fovea schema`: prints the JSON schema of graph files, for editors.
#include <cstdio>
#include <memory>

#include "framework/base/paths.h"
#include "framework/graph/compile/compile.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/report/schema.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/author/graph_files.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

// The stock graphs and their parts, which files extend.
std::vector<graph::KnownGraph> knownGraphs() {
  const std::vector<std::filesystem::path> folders = dataFolders("graphs");
  std::vector<graph::KnownGraph> graphs;
  for (const auto& [name, file] : graphFiles(folders, true)) {
    Diagnostics ignored;  // parts are incomplete
    graphs.push_back({name, graph::load(file.string(), {{}, folders}, ignored)});
  }
  return graphs;
}

}  // namespace

void addSchema(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("schema", "Print the JSON schema of graph files, for editors");
  struct Options {
    std::vector<std::string> plugins, folders;
    bool pass = false;
  };
  auto options = std::make_shared<Options>();
  addPluginOption(*command, options->plugins);
  addPassesOption(*command, options->folders);
  command->add_flag("--pass", options->pass, "Print the schema of pass files (NAME.pass.json) instead");
  command->callback([options, &action] {
    action = [options] {
      loadPlugins(options->plugins);
      loadPassFolders(options->folders);
      std::fputs(options->pass ? graph::passFileSchema().c_str()
                               : graph::generateSchema(graph::Registry::global(), knownGraphs()).c_str(),
                 stdout);
      return ExitCode::Ok;
    };
  });
}

}  // namespace fovea::cli
