// Where fovea's data files lie: shaders, graphs and scenes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

// Existing folders that may hold `shaders`, `graphs` and `scenes`, first match wins, no duplicates:
//   1. every folder of $FOVEA_DATA (colon-separated),
//   2. beside the program, then beside libfovea.so: ../share/fovea and the folder itself (a portable bundle),
//   3. the source tree the library was built from, while it exists,
//   4. the installation prefix the library was configured for.
// Throws Error(BadInput) when $FOVEA_DATA names something that is not a folder.
std::vector<std::filesystem::path> dataDirectories();

// The existing sub-folders of one kind: "shaders", "graphs" or "scenes" (in the source tree scenes lie in samples/scenes).
std::vector<std::filesystem::path> dataFolders(std::string_view kind);

// Folder of the running program; "" where the system does not tell.
std::filesystem::path programFolder();

}  // namespace fovea
