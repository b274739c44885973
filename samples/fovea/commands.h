// The commands of the program `fovea`. Each function adds a command with its options to the command line; if the user
// chooses the command, `action` is set to what runs it.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "fovea/error.h"

namespace fovea::cli {

using Action = std::function<ExitCode()>;

void addRender(CLI::App& program, Action& action);
void addCheck(CLI::App& program, Action& action);
void addMigrate(CLI::App& program, Action& action);
void addGraphs(CLI::App& program, Action& action);  // graphs, describe
void addFormat(CLI::App& program, Action& action);  // fmt
void addDiff(CLI::App& program, Action& action);    // diff
void addNew(CLI::App& program, Action& action);     // new graph, new pass
void addCompletion(CLI::App& program, Action& action);
void addPasses(CLI::App& program, Action& action);
void addSchema(CLI::App& program, Action& action);
void addDevices(CLI::App& program, Action& action);
void addScene(CLI::App& program, Action& action);
void addCompare(CLI::App& program, Action& action);
void addBench(CLI::App& program, Action& action);
void addCompareSequence(CLI::App& program, Action& action);
void addView(CLI::App& program, Action& action);
void addVr(CLI::App& program, Action& action);
void addSceneExport(CLI::App& sceneCommand, Action& action);
void addBenchModel(CLI::App& benchCommand, Action& action);

}  // namespace fovea::cli
