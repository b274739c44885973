#include "samples/fovea/view/watcher.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace fovea::view {
namespace {

constexpr size_t kMostFolders = 500;

// What graphs, passes and scenes are made of.
bool matters(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 11> kEndings = {".json", ".comp", ".frag", ".vert", ".glsl", ".h",
                                                         ".csv",  ".gltf", ".glb",  ".bin",  ".so"};
  const std::string name = file.filename().string();
  return !name.starts_with(".") &&
         std::find(kEndings.begin(), kEndings.end(), file.extension().string()) != kEndings.end();
}

}  // namespace

Watcher::Watcher() : queue_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

Watcher::~Watcher() {
  if (queue_ >= 0) close(queue_);
}

void Watcher::watch(const std::set<std::filesystem::path>& folders) {
  if (queue_ < 0) return;
  std::set<std::filesystem::path> known;
  for (auto at = folders_.begin(); at != folders_.end();) {
    if (folders.contains(at->second)) {
      known.insert((at++)->second);
      continue;
    }
    inotify_rm_watch(queue_, at->first);
    at = folders_.erase(at);
  }
  for (const std::filesystem::path& folder : folders) {
    if (known.contains(folder)) continue;
    const int id =
        inotify_add_watch(queue_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE | IN_ONLYDIR);
    if (id >= 0) folders_[id] = folder;
  }
}

std::set<std::filesystem::path> Watcher::changed() {
  std::set<std::filesystem::path> files;
  if (queue_ < 0) return files;
  alignas(inotify_event) std::array<char, 16384> bytes;
  for (;;) {
    const ssize_t size = read(queue_, bytes.data(), bytes.size());
    if (size <= 0) return files;
    for (ssize_t at = 0; at < size;) {
      inotify_event event;
      std::memcpy(&event, bytes.data() + at, sizeof event);
      const auto folder = folders_.find(event.wd);
      if (folder != folders_.end() && event.len > 0) {
        const std::filesystem::path file = folder->second / (bytes.data() + at + sizeof event);
        if (matters(file)) files.insert(file);
      }
      at += ssize_t(sizeof event + event.len);
    }
  }
}

std::set<std::filesystem::path> withSubfolders(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> all;
  std::error_code ec;
  if (!std::filesystem::is_directory(folder, ec)) return all;
  all.insert(folder);
  for (std::filesystem::recursive_directory_iterator at(folder, ec), end;
       !ec && at != end && all.size() < kMostFolders; at.increment(ec))
    if (at->is_directory(ec)) all.insert(at->path());
  return all;
}

}  // namespace fovea::view
