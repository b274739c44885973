#include "framework/gpu/loader/driver_files.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/base/files.h"
#include "framework/base/json.h"

namespace fovea::gpu {
namespace {

namespace fs = std::filesystem;

// The files and folders of a list with colons.
std::vector<fs::path> listed(const char* variable, const char* otherwise) {
  const char* value = std::getenv(variable);
  std::string list = value && *value ? value : otherwise;
  std::vector<fs::path> paths;
  for (size_t begin = 0; begin < list.size();) {
    const size_t end = std::min(list.find(':', begin), list.size());
    if (end > begin) paths.emplace_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return paths;
}

// Where the loader looks ("Architecture of the Vulkan Loader Interfaces", Driver Discovery on Linux).
std::vector<fs::path> placesOfDrivers() {
  for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
    if (const std::vector<fs::path> own = listed(variable, ""); !own.empty()) return own;
  std::vector<fs::path> places = listed("VK_ADD_DRIVER_FILES", "");
  const char* home = std::getenv("HOME");
  const fs::path user = home ? home : "";
  const std::pair<const char*, std::string> roots[] = {{"XDG_CONFIG_HOME", user / ".config"},
                                                       {"XDG_CONFIG_DIRS", "/etc/xdg"},
                                                       {"", "/etc"},
                                                       {"XDG_DATA_HOME", user / ".local/share"},
                                                       {"XDG_DATA_DIRS", "/usr/local/share:/usr/share"}};
  for (const auto& [variable, otherwise] : roots)
    for (const fs::path& root : listed(variable, otherwise.c_str())) places.push_back(root / "vulkan/icd.d");
  return places;
}

bool isDamaged(const fs::path& file) {
  if (file.extension() != ".json" || !whyUnreadable(file).empty()) return false;
  try {
    json::parseFile(file);
    return false;
  } catch (const Error&) {
    return true;
  }
}

}  // namespace

fs::path damagedDriverFile() {
  for (const fs::path& place : placesOfDrivers()) {
    if (isDamaged(place)) return place;
    std::error_code none;
    std::vector<fs::path> files;
    for (fs::directory_iterator at(place, none), end; !none && at != end; at.increment(none))
      files.push_back(at->path());
    std::ranges::sort(files);
    const auto found = std::ranges::find_if(files, isDamaged);
    if (found != files.end()) return *found;
  }
  return {};
}

}  // namespace fovea::gpu
