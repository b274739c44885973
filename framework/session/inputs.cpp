#include "framework/session/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "fovea/graph.h"
#include "framework/base/paths.h"

namespace fovea::session {

namespace {

namespace fs = std::filesystem;

template <class T>
std::optional<T> parseNumber(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

glm::uvec2 parseSize(std::string_view text) {
  const size_t x = text.find('x');
  const auto width = parseNumber<uint64_t>(text.substr(0, x));
  const auto height = x == text.npos ? std::nullopt : parseNumber<uint64_t>(text.substr(x + 1));
  if (!width || !height)
    throw Error(ExitCode::Usage, fmt::format("--size `{}` is not WIDTHxHEIGHT", text),
                "e.g. --size 1024x768");
  if (*width < 1 || *height < 1 || *width > kMaxSize || *height > kMaxSize)
    throw Error(
        ExitCode::Usage,
        fmt::format("--size {} is out of range: width and height go from 1 to {} pixels", text, kMaxSize),
        "e.g. --size 1024x768");
  return {uint32_t(*width), uint32_t(*height)};
}

glm::vec2 parseGaze(std::string_view text) {
  const size_t comma = text.find(',');
  const auto x = parseNumber<float>(text.substr(0, comma));
  const auto y = comma == text.npos ? std::nullopt : parseNumber<float>(text.substr(comma + 1));
  // Written so that NaN also fails.
  const auto inside = [](std::optional<float> v) { return v && *v >= 0 && *v <= 1; };
  if (!inside(x) || !inside(y))
    throw Error(ExitCode::Usage, fmt::format("--gaze `{}` is not X,Y with both from 0 to 1", text),
                "0,0 is the top left corner of the image and 0.5,0.5 its middle");
  return {*x, *y};
}

scene::Lens parseLens(std::string_view text) {
  std::vector<float> angles;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const auto angle = parseNumber<float>(text.substr(from, comma - from));
    // Written so that NaN also fails.
    angles.push_back(angle && *angle >= scene::kLeastLensAngle && *angle <= scene::kMostLensAngle
                         ? glm::radians(*angle)
                         : 0);
    from = comma + 1;
  }
  if (angles.size() != 4 || std::count(angles.begin(), angles.end(), 0.0f) > 0)
    throw Error(ExitCode::Usage,
                fmt::format("--lens `{}` is not four angles from {} to {} degrees", text,
                            scene::kLeastLensAngle, scene::kMostLensAngle),
                "outwards, inwards, up and down, as in 55,45,50,52");
  return {angles[0], angles[1], angles[2], angles[3]};
}

std::vector<std::string> sceneNames(const std::vector<std::string>& filesAndFolders) {
  std::vector<std::string> scenes;
  for (const std::string& given : filesAndFolders) {
    std::error_code unreadable;
    if (!fs::path(given).has_parent_path() || !fs::is_directory(given, unreadable)) {
      scenes.push_back(given);
      continue;
    }
    std::set<std::string> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(given, unreadable))
      if (entry.path().extension() == ".json") files.insert(entry.path().string());
    if (files.empty())
      throw Error(ExitCode::BadInput,
                  fmt::format("the folder `{}` has no readable scene files (.json)", given),
                  "write one that names the model; samples/scenes/README.md describes them");
    scenes.insert(scenes.end(), files.begin(), files.end());
  }
  std::map<std::string, std::string> known;
  for (const std::string& scene : scenes) {
    const auto [other, isNew] = known.emplace(fs::path(scene).stem().string(), scene);
    if (!isNew)
      throw Error(ExitCode::Usage,
                  fmt::format("the scenes `{}` and `{}` are both called `{}`, and so would their results",
                              other->second, scene, other->first),
                  "rename one of the files, or name the scene once");
  }
  return scenes;
}

void loadPlugins(const std::vector<std::string>& plugins) {
  for (const std::string& plugin : plugins) graph::loadPlugin(plugin);
}

void loadPassFolders(const std::vector<std::string>& folders) {
  graph::Registry::global().addFoldersFromEnvironment();
  for (const std::string& folder : folders) graph::Registry::global().addFolder(folder);
}

graph::Description loadGraph(const GraphOptions& options, Diagnostics& messages) {
  loadPlugins(options.plugins);
  loadPassFolders(options.passes);
  graph::LoadOptions load;
  for (const std::string& text : options.set) load.overrides.push_back(graph::parseOverride(text));
  load.searchPaths = dataFolders("graphs");
  graph::Registry::global().addFolderBeside(graph::findGraph(options.graph, load.searchPaths));
  return graph::load(options.graph, load, messages);
}

void printWarnings(const Diagnostics& messages) {
  static std::set<std::string> printed;
  for (const Diagnostic& d : messages.list()) {
    const std::string text = d.format();
    if (d.severity != Severity::Error && printed.insert(text).second)
      std::fprintf(stderr, "fovea: %s\n", text.c_str());
  }
}

std::string formatHash(uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string quoteList(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
  return text.empty() ? "none" : text;
}

}  // namespace fovea::session
