#include "framework/gpu/loader/driver_files.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/base/files.h"
#include "framework/base/json.h"
#include "framework/base/paths.h"

namespace fovea::gpu {
namespace {

namespace fs = std::filesystem;

// Where the loader looks ("Architecture of the Vulkan Loader Interfaces", Driver Discovery on Linux).
std::vector<fs::path> placesOfDrivers() {
  for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
    if (const std::vector<fs::path> own = pathsInVariable(variable); !own.empty()) return own;
  std::vector<fs::path> places = pathsInVariable("VK_ADD_DRIVER_FILES");
  const char* home = std::getenv("HOME");
  const fs::path user = home ? home : "";
  const std::pair<const char*, std::vector<fs::path>> roots[] = {
      {"XDG_CONFIG_HOME", {user / ".config"}},
      {"XDG_CONFIG_DIRS", {"/etc/xdg"}},
      {"", {"/etc"}},
      {"XDG_DATA_HOME", {user / ".local/share"}},
      {"XDG_DATA_DIRS", {"/usr/local/share", "/usr/share"}}};
  for (const auto& [variable, otherwise] : roots) {
    const std::vector<fs::path> own = pathsInVariable(variable);
    for (const fs::path& root : own.empty() ? otherwise : own) places.push_back(root / "vulkan/icd.d");
  }
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
