// Options that several commands share, and the parsing of their values.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "framework/session/compared.h"
#include "framework/session/inputs.h"

namespace fovea::cli {

using namespace session;  // NOLINT(google-build-using-namespace): the program is a shell around that room

void addPluginOption(CLI::App& command, std::vector<std::string>& plugins);
void addPassesOption(CLI::App& command, std::vector<std::string>& folders);
// GRAPH, --set, --plugin, --passes, --rays, and an option for each of graph::viewParameters(), such as --fovea-radius
void addGraphOptions(CLI::App& command, GraphOptions& options);
// --device, --without
void addDeviceOptions(CLI::App& command, std::string& device, std::vector<std::string>& without);
// --without
void addWithoutOption(CLI::App& command, std::vector<std::string>& without);
// --frame-limit
void addFrameLimitOption(CLI::App& command, double& seconds);
// --follow-links
void addFollowLinksOption(CLI::App& command);
// --json
void addJsonFlag(CLI::App& command, bool& json);
// --environment
void addEnvironmentOption(CLI::App& command, std::string& file);
// --gaze, --radius, --layer, --exposure, --json
void addCompareOptions(CLI::App& command, CompareOptions& options);
// The text of a file. Throws Error(BadInput) naming it; kind: what is wanted, in words.
std::string readText(const std::string& file, const char* kind);
// Adds an option that may be given several times, each time with one value.
CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                     const std::string& doc);
// Validators, of which every option that is a number has one. They accept the numbers that parseDecimal() reads, and
// their messages name the range. CLI11's own checks will not do, since they let NaN pass and read 010 as 8.
CLI::Validator numberBetween(double low, double high);
// Give it to `transform()`, which replaces 5e2 and 500.0 by 500, as an option of an integer type expects it.
CLI::Validator wholeNumberBetween(int64_t low, int64_t high);

}  // namespace fovea::cli
