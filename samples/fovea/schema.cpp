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
  auto plugins = std::make_shared<std::vector<std::string>>();
  addPluginOption(*command, *plugins);
  command->callback([plugins, &action] {
    action = [plugins] {
      loadPlugins(*plugins);
      std::fputs(graph::generateSchema(graph::Registry::global()).c_str(), stdout);
      return ExitCode::Ok;
    };
  });
}

}  // namespace fovea::cli
