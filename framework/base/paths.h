// The folders of fovea's data files: shaders, graphs and scenes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

// Existing folders that may hold `shaders`, `graphs` and `scenes`, in order of precedence and without duplicates:
//   1. every folder of $FOVEA_DATA (colon-separated),
//   2. beside the program, then beside libfovea.so: ../share/fovea and the folder itself (a portable bundle),
//   3. the source tree the library was built from, while it exists,
//   4. the installation prefix the library was configured for.
// Throws Error(BadInput) if $FOVEA_DATA names something that is not a folder.
std::vector<std::filesystem::path> dataDirectories();

// The existing sub-folders of one kind: "shaders", "graphs" or "scenes". In the source tree,
// scenes are in samples/scenes.
std::vector<std::filesystem::path> dataFolders(std::string_view kind);
// Where shaders are looked for: the library that passes include, then the folders of the passes themselves.
std::vector<std::filesystem::path> shaderFolders();

// The paths in an environment variable, separated by colons.
std::vector<std::filesystem::path> pathsInVariable(const char* name);

// The folder of the running program; "" if the system does not tell.
std::filesystem::path programFolder();

// The folder of libfovea.so; "" if the system does not tell.
std::filesystem::path libraryFolder();

}  // namespace fovea
