// Files for fuzz targets of what is read from files only.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace fovea::test {

// In memory, if the system has a place for that: on a disk, each change of a file may take milliseconds.
inline std::filesystem::path fuzzFolder() {
  const std::filesystem::path memory = "/dev/shm";
  return ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
}

class FuzzFile {
 public:
  explicit FuzzFile(const std::string& extension)
      : path_(fuzzFolder() / ("fovea-fuzz-" + std::to_string(getpid()) + extension)) {}
  ~FuzzFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  FuzzFile(const FuzzFile& other) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  void write(const uint8_t* data, size_t size) const {
    std::ofstream(path_, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace fovea::test
