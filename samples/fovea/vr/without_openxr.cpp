// The command `fovea vr` of a build without OpenXR.
#include "samples/fovea/commands.h"

namespace fovea::cli {

void addVr(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("vr", "Show a running graph in a headset (not in this build)");
  command->allow_extras();
  command->callback([&action] {
    action = []() -> ExitCode {
      throw Error(ExitCode::Usage, "this fovea was built without OpenXR",
                  "install libopenxr-dev, which samples/setup.sh does, and build again");
    };
  });
}

}  // namespace fovea::cli
