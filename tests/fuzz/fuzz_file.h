// A file for fuzz targets of what is read from files only.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace fovea::test {

class FuzzFile {
 public:
  explicit FuzzFile(const std::string& extension)
      : path_(std::filesystem::temp_directory_path() /
              ("fovea-fuzz-" + std::to_string(getpid()) + extension)) {}
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
