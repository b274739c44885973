// The command `fovea schema`: prints the JSON schema of graph files, for editors.
#include <cstdio>
#include <memory>

#include "framework/graph/pass/registry.h"
#include "framework/graph/report/schema.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {

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
                               : graph::generateSchema(graph::Registry::global()).c_str(),
                 stdout);
      return ExitCode::Ok;
    };
  });
}

}  // namespace fovea::cli
