// The command-line program: renders and checks graphs, and lists passes, scenes and devices.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"
#include "fovea/passes.h"
#include "fovea/scenes.h"
#include "framework/base/legible.h"
#include "framework/base/memory.h"
#include "framework/base/threads.h"
#include "framework/session/interrupt.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

constexpr const char* kFooter =
    R"(Exit codes: 0 done, 1 a defect of fovea or of a pass, 2 wrong command line, 3 a graph, scene, image,
shader or plug-in that cannot be used, 4 no usable Vulkan device, 5 out of memory, 6 device lost or a frame
too long, 7 a file could not be written, 8 passes became slower than the baseline (bench passes),
130 interrupted.)";

ExitCode report(ExitCode code, const std::string& text) {
  std::fflush(stdout);
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    // Remedies are indented below their message.
    std::fprintf(stderr, "%s%s\n", line.starts_with("  ") ? "" : "fovea: ", line.c_str());
    begin = end + 1;
  }
  return code;
}

// The command whose help explains a usage error.
std::string chosenCommand(const CLI::App& program) {
  std::string name = "fovea";
  for (const CLI::App* app = &program; !app->get_subcommands().empty();) {
    app = app->get_subcommands().front();
    name += ' ' + app->get_name();
  }
  return name;
}

// CLI11 alone would only report that a command is missing.
void refuseUnknownCommand(const CLI::App& program, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string nearest = nearestName(word, names);
  throw Error(ExitCode::Usage, "there is no command `" + word + "`",
              nearest.empty() ? "see `fovea --help`" : "did you mean `" + nearest + "`?");
}

ExitCode parseAndRun(int argc, char** argv) {
  CLI::App program(
      "Renders a scene with a render graph, shows what graphs, passes, scenes and devices there are, "
      "compares pictures, and measures.",
      "fovea");
  program.set_version_flag("--version", "fovea " FOVEA_VERSION, "Print the version");
  program.footer(kFooter);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  Action action;
  addRender(program, action);
  addView(program, action);
  addVr(program, action);
  addCheck(program, action);
  addMigrate(program, action);
  addFormat(program, action);
  addDiff(program, action);
  addNew(program, action);
  addCompletion(program, action);
  addGraphs(program, action);
  addPasses(program, action);
  addSchema(program, action);
  addDevices(program, action);
  addScene(program, action);
  addCompare(program, action);
  addCompareSequence(program, action);
  addBench(program, action);
  if (argc > 1) refuseUnknownCommand(program, argv[1]);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return ExitCode(program.exit(e));  // --help, --version
    return report(ExitCode::Usage, legible(e.what()) + "\n  -> see `" + chosenCommand(program) + " --help`");
  }
  passes::registerAll();
  scenes::registerAll();
  return action();
}

ExitCode run(int argc, char** argv) {
  try {
    return parseAndRun(argc, argv);
  } catch (const Error& e) {
    return report(e.code(), e.what());
  } catch (const std::bad_alloc&) {
    return report(
        ExitCode::OutOfMemory,
        "error: the computer's memory is exhausted\n  -> render a smaller --size, or a smaller scene");
  } catch (const std::system_error& e) {
    if (isNoThread(e)) return report(ExitCode::OutOfMemory, noThread(e).what());
    return report(ExitCode::Internal,
                  std::string("error: a defect of fovea, not of your input: ") + e.what());
  } catch (const std::exception& e) {
    return report(ExitCode::Internal,
                  std::string("error: a defect of fovea, not of your input: ") + e.what());
  } catch (...) {
    return report(ExitCode::Internal, "error: a defect of fovea, not of your input: an unknown exception");
  }
}

// Libraries run out of memory where they have promised not to throw, as the standard library does in folders. That ends
// the program with the same message and code as anywhere else.
const std::terminate_handler kUsualEnd = std::get_terminate();
void terminate() {
  try {
    if (const std::exception_ptr current = std::current_exception()) std::rethrow_exception(current);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view kMessage = "fovea: error: there is not enough memory\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
    std::_Exit(int(ExitCode::OutOfMemory));
  } catch (...) {  // the usual end says what it was
  }
  kUsualEnd();
}

}  // namespace
}  // namespace fovea::cli

int main(int argc, char** argv) {
  std::set_terminate(fovea::cli::terminate);
  fovea::session::stopAtInterrupts();
  fovea::keepFreedMemory();
  const fovea::ExitCode code = fovea::cli::run(argc, argv);
  if (std::fflush(stdout) != 0 && code == fovea::ExitCode::Ok) {
    std::fputs("fovea: error: standard output could not be written\n", stderr);
    return int(fovea::ExitCode::CannotWrite);
  }
  return int(code);
}
