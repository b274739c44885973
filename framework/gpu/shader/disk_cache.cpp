#include "framework/gpu/shader/disk_cache.h"

#include <unistd.h>
#include <xxhash.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace fovea::gpu {
namespace {

struct Header {
  char magic[8] = {'f', 'o', 'v', 'e', 'a', 'c', '0', '1'};
  uint64_t bytes = 0;
  uint64_t hash = 0;  // of the payload
};

}  // namespace

std::filesystem::path defaultCacheDirectory() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
    return std::filesystem::path(xdg) / "fovea";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache" / "fovea";
  return {};
}

std::string ContentKey::hex() const {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return text;
}

ContentKey contentKey(std::string_view bytes) {
  const XXH128_hash_t h = XXH3_128bits(bytes.data(), bytes.size());
  return {h.low64, h.high64};
}

std::optional<std::vector<std::byte>> readCacheFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return std::nullopt;
  const std::streamoff size = in.tellg();
  Header header;
  const Header expected;
  if (size < std::streamoff(sizeof header)) return std::nullopt;
  in.seekg(0);
  in.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!in || std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0 ||
      header.bytes != uint64_t(size) - sizeof header)
    return std::nullopt;
  std::vector<std::byte> payload(header.bytes);
  in.read(reinterpret_cast<char*>(payload.data()), std::streamsize(payload.size()));
  if (!in || XXH3_64bits(payload.data(), payload.size()) != header.hash) return std::nullopt;
  return payload;
}

bool writeCacheFile(const std::filesystem::path& file, std::span<const std::byte> payload) {
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::filesystem::path temporary = file;
  temporary += "." + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
  Header header;
  header.bytes = payload.size();
  header.hash = XXH3_64bits(payload.data(), payload.size());
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(reinterpret_cast<const char*>(payload.data()), std::streamsize(payload.size()));
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, error);
      return false;
    }
  }
  std::filesystem::rename(temporary, file, error);
  if (!error) return true;
  std::filesystem::remove(temporary, error);
  return false;
}

}  // namespace fovea::gpu
