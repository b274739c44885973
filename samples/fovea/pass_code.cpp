#include "samples/fovea/pass_code.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "framework/base/paths.h"
#include "framework/graph/hash.h"
#include "samples/fovea/arguments.h"

namespace fovea::cli {
namespace {

namespace fs = std::filesystem;

// Names and contents of all files of a folder, wherever the folder is.
void addFolder(graph::detail::Hasher& hash, const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored))
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    hash.add(std::string_view(file.lexically_relative(folder).string()));
    hash.add(std::string_view(text.str()));
  }
}

}  // namespace

std::string passCode(const std::string& type) {
  static std::map<std::string, std::string> known;
  std::string& code = known[type];
  if (!code.empty()) return code;
  graph::detail::Hasher hash;
  for (const auto& [name, sources] : kPassSources)
    if (name == type) hash.add(sources);
  for (const fs::path& folder : dataFolders("shaders")) {
    std::error_code ignored;
    for (const fs::path& part : {folder / type, folder / "common"})
      if (fs::is_directory(part, ignored)) addFolder(hash, part);
  }
  return code = formatHash(hash.value());
}

}  // namespace fovea::cli
