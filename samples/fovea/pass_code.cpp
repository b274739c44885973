#include "samples/fovea/pass_code.h"

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

using Files = std::map<std::string, fs::path>;  // name as shaders include it -> the first such file

void findFiles(const fs::path& shaders, const std::string& part, Files& files) {
  std::error_code ignored;
  for (fs::recursive_directory_iterator entry(shaders / part, ignored), end; entry != end;
       entry.increment(ignored))
    if (entry->is_regular_file(ignored))
      files.try_emplace(entry->path().lexically_relative(shaders).string(), entry->path());
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

std::string passCode(const std::string& type) {
  static std::map<std::string, std::string> known;
  std::string& code = known[type];
  if (!code.empty()) return code;
  graph::detail::Hasher hash;
  for (const auto& [name, sources] : kPassSources)
    if (name == type) hash.add(sources);
  Files files;
  for (const fs::path& folder : dataFolders("shaders"))
    for (const std::string& part : {type, std::string("common")}) findFiles(folder, part, files);
  for (const auto& [name, file] : files) {
    hash.add(std::string_view(name));
    hash.add(std::string_view(contentOf(file)));
  }
  return code = formatHash(hash.value());
}

}  // namespace fovea::cli
