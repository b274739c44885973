// The graph files that there are.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fovea::cli {

// The graphs of the folders by name ("alternatives/ddgi"); those of earlier folders first where names are the same. Parts
// are there for others to build on, and run by themselves only in part.
std::map<std::string, std::filesystem::path> graphFiles(const std::vector<std::filesystem::path>& folders,
                                                        bool parts = false);

}  // namespace fovea::cli
