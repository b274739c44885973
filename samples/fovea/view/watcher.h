// Tells which files in some folders have changed (inotify).
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fovea::view {

class Watcher {
 public:
  // Where the system grants no inotify, nothing is ever reported.
  Watcher();
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  // Watches these folders instead of those before. What is no folder is left out.
  void watch(const std::set<std::filesystem::path>& folders);
  // The files that were written, moved, made or removed since the last call. Never waits. Files that editors keep beside
  // the one that is edited are not among them.
  std::set<std::filesystem::path> changed();

 private:
  int queue_ = -1;
  std::map<int, std::filesystem::path> folders_;
};

// A folder with all folders in it, up to a sensible number.
std::set<std::filesystem::path> withSubfolders(const std::filesystem::path& folder);

}  // namespace fovea::view
