// The option --eyes of `compare` and `compare-sequence`.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "framework/image/eyes.h"

namespace fovea::cli {

CLI::Option* addEyesFlag(CLI::App& command, bool& eyes);

// Prints the measures of all regions. head: what JSON begins with, or null to print `title` and a table instead.
void printEyes(const image::EyesComparison& comparison, const nlohmann::ordered_json& head,
               const std::string& title);

}  // namespace fovea::cli
