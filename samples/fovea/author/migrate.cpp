// The command `fovea migrate`: rewrites graph files of earlier versions.
#include <fmt/format.h>

#include <memory>

#include "framework/base/text_file.h"
#include "framework/graph/migrate/migrate.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

struct MigrateOptions {
  std::vector<std::string> files;
  bool check = false;
};

ExitCode migrate(const MigrateOptions& options) {
  bool old = false;
  for (const std::string& file : options.files) {
    const std::string text = readText(file, "graph file");
    std::vector<graph::Change> changes;
    const std::string migrated = graph::migrateText(text, file, changes);
    for (const graph::Change& change : changes)
      fmt::print("{}:{}:{}: {}\n", file, change.where.line, change.where.column, change.what);
    if (migrated == text) continue;
    old = true;
    if (!options.check) writeText(file, migrated);
    fmt::print("{}: {} version {}\n", file, options.check ? "is older than" : "is now of",
               graph::kGraphVersion);
  }
  return old && options.check ? ExitCode::BadInput : ExitCode::Ok;
}

}  // namespace

void addMigrate(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("migrate", "Rewrite graph files of earlier versions as this one reads them");
  auto options = std::make_shared<MigrateOptions>();
  command->add_option("FILE", options->files, "Graph files, rewritten in place")->required()->type_name("");
  command->add_flag("--check", options->check,
                    "Change no file, but say what would change, with exit code 3 if anything would");
  command->callback([options, &action] { action = [options] { return migrate(*options); }; });
}

}  // namespace fovea::cli
