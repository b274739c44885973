// Files in the cache folder, each either complete or absent. A damaged or foreign file counts as absent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fovea::gpu {

// $XDG_CACHE_HOME/fovea, else $HOME/.cache/fovea; empty when neither variable is set.
std::filesystem::path defaultCacheDirectory();

// A 128-bit content hash, so that collisions can be ruled out.
struct ContentKey {
  uint64_t low = 0, high = 0;
  std::string hex() const;
};
ContentKey contentKey(std::string_view bytes);

// The payload stored in this file, if the file exists and is complete and undamaged.
std::optional<std::vector<std::byte>> readCacheFile(const std::filesystem::path& file);
// Writes under a temporary name and renames, so that readers and other processes never see half a file. Failing to
// write is not an error: it only costs time.
bool writeCacheFile(const std::filesystem::path& file, std::span<const std::byte> payload);

}  // namespace fovea::gpu
