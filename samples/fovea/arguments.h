// Options that several commands share, and the parsing of their values.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/runner/compared.h"
#include "benchmarks/runner/inputs.h"
#include "framework/scene/scene.h"

namespace fovea::cli {

using namespace bench;  // NOLINT(google-build-using-namespace): the program is a shell around that library

void addPluginOption(CLI::App& command, std::vector<std::string>& plugins);
void addGraphOptions(CLI::App& command, GraphOptions& options);  // GRAPH, --set, --plugin
void addCompareOptions(CLI::App& command,
                       CompareOptions& options);  // --gaze, --radius, --layer, --exposure, --json
// Adds an option that may be given several times, each time with one value.
CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                     const std::string& doc);
// Unlike CLI::Range, refuses NaN.
CLI::Validator numberBetween(double low, double high);

// Parses "55,45,50,52": degrees outwards, inwards, up, down. Throws Error(Usage).
scene::Lens parseLens(std::string_view text);

}  // namespace fovea::cli
