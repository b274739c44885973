#include "framework/base/paths.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>

#include "fovea/error.h"
#include "framework/base/files.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

// Adds a folder if it exists and is not yet in the list.
void addFolder(std::vector<fs::path>& list, const fs::path& folder) {
  std::error_code ignored;
  if (folder.empty() || !fs::is_directory(folder, ignored)) return;
  const fs::path canonical = fs::weakly_canonical(folder, ignored);
  if (!canonical.empty() && std::find(list.begin(), list.end(), canonical) == list.end())
    list.push_back(canonical);
}

// The folder of a program or library counts as a data folder only if it holds data; /usr/bin does not.
void addBeside(std::vector<fs::path>& list, const fs::path& folder) {
  if (folder.empty()) return;
  addFolder(list, folder / "../share/fovea");
  addFolder(list, folder / "../../share/fovea");  // lib/<multiarch>/libfovea.so
  std::error_code ignored;
  for (const fs::path& own : {folder, folder / ".."})
    if (fs::is_directory(own / "shaders", ignored) && fs::is_directory(own / "graphs", ignored))
      addFolder(list, own);
}

void addFromEnvironment(std::vector<fs::path>& list) {
  for (const fs::path& folder : pathsInVariable("FOVEA_DATA")) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
      throw Error(ExitCode::BadInput, "FOVEA_DATA names `" + folder.string() + "`, which is not a folder",
                  "unset FOVEA_DATA, or let it name a folder with shaders, graphs and scenes");
    addFolder(list, folder);
  }
}

}  // namespace

std::vector<fs::path> pathsInVariable(const char* name) {
  const char* variable = std::getenv(name);
  const std::string text = variable ? variable : "";
  std::vector<fs::path> paths;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(':', begin), text.size());
    if (end > begin) paths.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return paths;
}

fs::path programFolder() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  return failed ? fs::path() : program.parent_path();
}

fs::path libraryFolder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&libraryFolder), &info) == 0 || !info.dli_fname) return {};
  std::error_code ignored;
  return fs::weakly_canonical(info.dli_fname, ignored).parent_path();
}

std::vector<fs::path> dataDirectories() {
  std::vector<fs::path> list;
  addFromEnvironment(list);
  addBeside(list, programFolder());
  addBeside(list, libraryFolder());
  addFolder(list, FOVEA_SOURCE_DIR);
#ifdef FOVEA_DATA_DIR
  addFolder(list, FOVEA_DATA_DIR);
#endif
  return list;
}

std::vector<fs::path> dataFolders(std::string_view kind) {
  std::vector<fs::path> list;
  for (const fs::path& directory : dataDirectories()) {
    // A folder that cannot be looked into is not passed over in silence for the next one.
    for (const fs::path& folder : {directory / kind, directory / "samples" / kind})
      if (isFolder(folder)) addFolder(list, folder);
  }
  return list;
}

std::vector<fs::path> shaderFolders() {
  std::vector<fs::path> list = dataFolders("shaders");
  for (const fs::path& folder : dataFolders("passes")) addFolder(list, folder);
  return list;
}

}  // namespace fovea
