#include "benchmarks/runner/pass_code.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

#include "framework/base/hash.h"
#include "framework/base/paths.h"
#include "framework/session/inputs.h"

namespace fovea::bench {
namespace {

namespace fs = std::filesystem;

using Shaders = std::map<std::string, std::string>;  // name in #include -> text

std::optional<std::string> readShader(const std::string& name) {
  for (const fs::path& folder : shaderFolders()) {
    std::error_code ignored;
    if (!fs::is_regular_file(folder / name, ignored)) continue;
    std::ifstream in(folder / name, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  return {};
}

std::string withoutComments(const std::string& text) {
  static const std::regex kComment("//[^\n]*"), kSpace("[ \t\r\n]+");
  return std::regex_replace(std::regex_replace(text, kComment, ""), kSpace, " ");
}

// A shader and everything that it includes, directly or indirectly.
void addShader(const std::string& name, Shaders& shaders) {
  if (shaders.contains(name)) return;
  const std::optional<std::string> text = readShader(name);
  if (!text) return;
  shaders[name] = withoutComments(*text);
  static const std::regex kInclude("#include \"([^\"]+)\"");
  for (std::sregex_iterator found(text->begin(), text->end(), kInclude), end; found != end; ++found)
    addShader((*found)[1], shaders);
}

bool isShader(const fs::path& file) {
  const fs::path kind = file.extension();
  return kind == ".comp" || kind == ".frag" || kind == ".vert" || kind == ".glsl";
}

void addShadersIn(const std::string& part, Shaders& shaders) {
  std::error_code ignored;
  for (const fs::path& folder : shaderFolders())
    for (fs::recursive_directory_iterator entry(folder / part, ignored), end; entry != end;
         entry.increment(ignored))
      if (isShader(entry->path())) addShader(entry->path().lexically_relative(folder).string(), shaders);
}

std::string codeOf(std::string_view sources, const Shaders& shaders) {
  Hasher hash;
  hash.add(sources);
  for (const auto& [name, text] : shaders) hash.add(std::string_view(name)), hash.add(std::string_view(text));
  return session::formatHash(hash.value());
}

}  // namespace

std::string passCode(const std::string& type) {
  static std::map<std::string, std::string> known;
  std::string& code = known[type];
  if (!code.empty()) return code;
  std::string_view sources;
  for (const auto& [name, hash] : kPassSources)
    if (name == type) sources = hash;
  Shaders shaders;
  addShadersIn(type, shaders);
  return code = codeOf(sources, shaders);
}

std::string frameworkCode() {
  Shaders shaders;
  for (const char* kernel : {"animate", "refit", "refit_emitters", "subdivide"})
    addShader(std::string("scene/") + kernel + ".comp", shaders);
  return codeOf(kFrameworkSources, shaders);
}

}  // namespace fovea::bench
