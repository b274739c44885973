// The graphs and scenes that a page may choose from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fovea::view {

// Stock graphs and those beside `current`, by bare name, sorted.
std::vector<std::string> graphNames(const std::filesystem::path& current);
// The file of such a name; beside `current` first.
std::filesystem::path graphByName(const std::filesystem::path& current, const std::string& name);

}  // namespace fovea::view
