// Finds the shared test models, and writes small models in code.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/scene/load.h"
#include "framework/scene/scene.h"
#include "places.h"

namespace fovea::test {

// The folder with the models that are not part of the source; empty if it does not exist.
inline std::filesystem::path sharedScenes() {
  std::error_code ec;
  std::vector<std::filesystem::path> folders;
  if (const char* variable = std::getenv("FOVEA_SCENES")) folders.push_back(variable);
  folders.push_back(std::filesystem::path(FOVEA_SOURCE_DIR) / ".." / "shared" / "scenes");
  for (const auto& f : folders)
    if (std::filesystem::is_directory(f / "conformance", ec)) return std::filesystem::weakly_canonical(f);
  return {};
}

// Declares `folder`. NOLINTBEGIN(bugprone-macro-parentheses): it is a name, which takes no parentheses.
#define FOVEA_NEED_SCENES(folder)                                                                   \
  const std::filesystem::path folder = fovea::test::sharedScenes();                                 \
  if (folder.empty())                                                                               \
  GTEST_SKIP() << "the shared test models are not here: put them into ../shared/scenes beside the " \
                  "source, or name their folder in FOVEA_SCENES"
// NOLINTEND(bugprone-macro-parentheses)

// A temporary folder that is removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fovea-scene-XXXXXX").string();
    if (!mkdtemp(pattern.data())) std::abort();
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The message of the Error that `action` throws; "" if it throws none.
template <class Action>
std::string errorOf(Action&& action, ExitCode expected = ExitCode::BadInput) {
  try {
    action();
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(expected)) << e.what();
    return e.what();
  }
  return {};
}

template <class T>
void appendBytes(std::string& to, const std::vector<T>& values) {
  to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

inline void appendU32(std::string& to, uint32_t v) {
  for (int i = 0; i < 4; ++i) to += char(v >> (8 * i) & 0xff);
}

inline std::string base64(const std::string& bytes) {
  static const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kAlphabet[v >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// The data of one triangle (0 0 0) (1 0 0) (0 1 0) with 16-bit indices at byte 36, as a data URI.
inline std::string triangleBytes() {
  std::string bytes;
  appendBytes<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  appendBytes<uint16_t>(bytes, {0, 1, 2});
  bytes.append(2, '\0');
  return bytes;
}

// A complete one-triangle document made of exchangeable parts. `extra` is added at the top level and starts
// with a comma.
struct TriangleDocument {
  std::string asset = R"({"version":"2.0"})";
  std::string bytes = triangleBytes();
  std::string bufferUri;  // if "", the bytes as a data URI
  std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";
  std::string accessors =
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])";
  std::string views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}])";
  std::string nodes = R"([{"mesh":0}])";
  std::string scenes = R"([{"nodes":[0]}])";
  std::string moreBuffers;  // starts with a comma
  std::string extra;

  std::string json(bool binary = false) const {
    const std::string uri =
        bufferUri.empty() ? "data:application/octet-stream;base64," + base64(bytes) : bufferUri;
    return R"({"asset":)" + asset + R"(,"scene":0,"scenes":)" + scenes + R"(,"nodes":)" + nodes +
           R"(,"meshes":[{"name":"tri","primitives":[)" + primitive + R"(]}],"accessors":)" + accessors +
           R"(,"bufferViews":)" + views + R"(,"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
           (binary ? "" : R"(,"uri":")" + uri + "\"") + "}" + moreBuffers + "]" + extra + "}";
  }

  std::string glb() const {
    std::string text = json(true);
    while (text.size() % 4) text += ' ';
    std::string bin = bytes;
    while (bin.size() % 4) bin += '\0';
    std::string out = "glTF";
    appendU32(out, 2);
    appendU32(out, uint32_t(12 + 8 + text.size() + 8 + bin.size()));
    appendU32(out, uint32_t(text.size()));
    out += "JSON" + text;
    appendU32(out, uint32_t(bin.size()));
    out += std::string("BIN\0", 4) + bin;
    return out;
  }
};

inline scene::Scene loadText(const TemporaryFolder& folder, const std::string& text, Diagnostics& warnings,
                             const std::string& name = "model.gltf") {
  return scene::loadGltf(folder.write(name, text), warnings);
}

inline std::string errorOfText(const std::string& text, const std::string& name = "model.gltf") {
  TemporaryFolder folder;
  Diagnostics warnings;
  return errorOf([&] { loadText(folder, text, warnings, name); });
}

// The warnings about a model that can be shown.
inline std::string warningsOfText(const std::string& text, const std::string& name = "model.gltf") {
  TemporaryFolder folder;
  Diagnostics warnings;
  EXPECT_EQ(errorOf([&] { flatten(loadText(folder, text, warnings, name)); }), "");
  return warnings.format();
}

// Whether a binary document in which one byte is changed still loads; if not, its message must be one
// about invalid input.
inline bool loadsChanged(const TemporaryFolder& folder, const std::string& good, size_t at, int change) {
  std::string bad = good;
  bad[at] = char(bad[at] ^ change);
  Diagnostics warnings;
  try {
    flatten(loadText(folder, bad, warnings, "model.glb"));
    return true;
  } catch (const Error& e) {
    EXPECT_EQ(int(e.code()), int(ExitCode::BadInput)) << "byte " << at << ": " << e.what();
    return false;
  }
}

}  // namespace fovea::test
