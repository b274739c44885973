// A shader with everything it includes, read once, so that what is hashed is exactly what is compiled.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fovea::gpu {

class ShaderSource {
 public:
  struct File {
    std::string name;                 // for messages
    std::filesystem::path directory;  // where its #includes are searched first; empty for plain text
    std::string text;                 // with a blank line in place of #pragma once
    bool once = false;                // has #pragma once
  };

  // Both throw Error(BadInput) if a file cannot be read. A missing #include is left to the compiler, which knows
  // whether it is in live code and on which line.
  static ShaderSource fromFile(const std::string& name,
                               const std::vector<std::filesystem::path>& searchPaths);
  static ShaderSource fromText(const std::string& name, std::string text,
                               const std::vector<std::filesystem::path>& searchPaths);

  const File& main() const { return files_.front(); }
  const std::vector<File>& files() const { return files_; }
  // The file that `header` refers to in `includer`; null if it is missing.
  const File* find(const std::string& includer, const std::string& header) const;
  // All of the above as one string: the texts, which of them have #pragma once, and which #include leads to which text.
  std::string serialize() const;

 private:
  void scan(size_t file, const std::vector<std::filesystem::path>& searchPaths);
  size_t load(const std::filesystem::path& path);
  std::vector<File> files_;
  std::map<std::filesystem::path, size_t> loaded_;
  std::map<std::pair<std::string, std::string>, size_t> includes_;  // (includer, header) -> file, or kMissing
};

}  // namespace fovea::gpu
