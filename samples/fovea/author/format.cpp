// The command `fovea fmt`: gives graph files their stable layout.
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <memory>

#include "framework/base/text_file.h"
#include "framework/graph/edit/format.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {

namespace {

struct FormatOptions {
  std::vector<std::string> files;
  bool check = false;
};

ExitCode formatFiles(const FormatOptions& options) {
  bool differs = false;
  for (const std::string& file : options.files) {
    const std::string text = readText(file, "graph file");
    const std::string formatted = graph::formatText(text, file);
    if (formatted == text) continue;
    differs = true;
    if (!options.check) writeText(file, formatted);
    fmt::print("{}: {}\n", file, options.check ? "has another layout" : "has its stable layout now");
  }
  return differs && options.check ? ExitCode::BadInput : ExitCode::Ok;
}

}  // namespace

std::string readText(const std::string& file, const char* kind) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream)
    throw Error(ExitCode::BadInput, file + " cannot be read", fmt::format("give the path of a {}", kind));
  return text;
}

void addFormat(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("fmt", "Give graph files their stable layout");
  auto options = std::make_shared<FormatOptions>();
  command->add_option("FILE", options->files, "Graph files, rewritten in place")->required()->type_name("");
  command->add_flag("--check", options->check,
                    "Change no file, but name those that would change, with exit code 3 if any would");
  command->callback([options, &action] { action = [options] { return formatFiles(*options); }; });
}

}  // namespace fovea::cli
