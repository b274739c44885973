#include "framework/gpu/shader/shader_source.h"

#include <fstream>
#include <iterator>
#include <optional>

#include "fovea/error.h"
#include "framework/base/files.h"
#include "framework/base/text_file.h"

namespace fovea::gpu {
namespace {

constexpr size_t kMissing = ~size_t(0);

std::string readText(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  noteRead(path);
  if (!in) throw Error(ExitCode::BadInput, "cannot read shader file `" + path.string() + "`");
  if (isUtf16(text))
    throw Error(ExitCode::BadInput, "the shader file `" + path.string() + "` is UTF-16", "save it as UTF-8");
  return std::string(withoutByteOrderMark(text));
}

// Relative to the current folder if the file lies below it, so that messages stay readable.
std::string displayName(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path relative = std::filesystem::proximate(path, error);
  if (error || relative.empty() || *relative.begin() == "..") return path.string();
  return relative.string();
}

std::string_view skipSpaces(std::string_view s) {
  const size_t first = s.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view{} : s.substr(first);
}

// `# include "x"` -> x. Directives in comments or dead code count as well, which only makes the hash stricter.
std::optional<std::string> includedName(std::string_view line) {
  line = skipSpaces(line);
  if (line.empty() || line[0] != '#') return std::nullopt;
  line = skipSpaces(line.substr(1));
  if (!line.starts_with("include")) return std::nullopt;
  line = skipSpaces(line.substr(7));
  if (line.empty() || (line[0] != '"' && line[0] != '<')) return std::nullopt;
  const size_t end = line.find(line[0] == '"' ? '"' : '>', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return std::string(line.substr(1, end - 1));
}

bool isPragmaOnce(std::string_view line) {
  line = skipSpaces(line);
  if (line.empty() || line[0] != '#') return false;
  line = skipSpaces(line.substr(1));
  return line.starts_with("pragma") && skipSpaces(line.substr(6)).starts_with("once");
}

void appendSized(std::string& out, std::string_view text) {
  out += std::to_string(text.size());
  out += ':';
  out += text;
}

}  // namespace

ShaderSource ShaderSource::fromFile(const std::string& name,
                                    const std::vector<std::filesystem::path>& searchPaths) {
  std::string searched;
  const bool absolute = std::filesystem::path(name).is_absolute();  // then there is nothing to search
  for (const std::filesystem::path& folder : absolute ? std::vector{std::filesystem::path()} : searchPaths) {
    if (const std::filesystem::path path = (folder / name).lexically_normal(); isFile(path)) {
      ShaderSource source;
      source.load(path);
      for (size_t i = 0; i < source.files_.size(); ++i) source.scan(i, searchPaths);
      return source;
    }
    searched += (searched.empty() ? "" : ", ") + folder.string();
  }
  throw Error(ExitCode::BadInput, "shader `" + name + "` not found",
              absolute           ? "put it there, or correct the name of the step's shader"
              : searched.empty() ? "no folder for shaders is known"
                                 : "looked in " + searched);
}

ShaderSource ShaderSource::fromText(const std::string& name, std::string text,
                                    const std::vector<std::filesystem::path>& searchPaths) {
  ShaderSource source;
  source.files_.push_back({name, {}, std::move(text), false});
  for (size_t i = 0; i < source.files_.size(); ++i) source.scan(i, searchPaths);
  return source;
}

size_t ShaderSource::load(const std::filesystem::path& path) {
  const auto [it, isNew] = loaded_.emplace(path, files_.size());
  if (isNew) files_.push_back({displayName(path), path.parent_path(), readText(path), false});
  return it->second;
}

void ShaderSource::scan(size_t file, const std::vector<std::filesystem::path>& searchPaths) {
  const std::string text = files_[file].text;  // a copy, because load() below may move the files
  const std::string name = files_[file].name;
  const std::filesystem::path own = files_[file].directory;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    if (isPragmaOnce(line)) {
      files_[file].once = true;
      // The compiler would only warn that it does not know the directive. A blank line keeps the numbers of the others.
      files_[file].text.replace(size_t(line.data() - text.data()), line.size(), line.size(), ' ');
    }
    const std::optional<std::string> header = includedName(line);
    if (!header) continue;
    size_t target = kMissing;
    if (const auto path = (own / *header).lexically_normal(); !own.empty() && isFile(path))
      target = load(path);
    for (size_t i = 0; i < searchPaths.size() && target == kMissing; ++i) {
      if (const auto path = (searchPaths[i] / *header).lexically_normal(); isFile(path)) target = load(path);
    }
    includes_[{name, *header}] = target;
  }
}

const ShaderSource::File* ShaderSource::find(const std::string& includer, const std::string& header) const {
  const auto it = includes_.find({includer, header});
  return it == includes_.end() || it->second == kMissing ? nullptr : &files_[it->second];
}

std::string ShaderSource::serialize() const {
  std::string out;
  for (const File& file : files_) {
    appendSized(out, file.text);
    out += file.once ? '1' : '0';
  }
  // Files are identified by index, not by path, so that another checkout finds the same entries. The order of files_
  // is that of the directives.
  for (size_t i = 0; i < files_.size(); ++i) {
    for (const auto& [key, target] : includes_) {
      if (key.first != files_[i].name) continue;
      appendSized(out, std::to_string(i));
      appendSized(out, key.second);
      appendSized(out, std::to_string(target));
    }
  }
  return out;
}

}  // namespace fovea::gpu
