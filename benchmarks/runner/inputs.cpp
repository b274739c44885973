#include "benchmarks/runner/inputs.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <optional>
#include <set>

#include "fovea/graph.h"
#include "framework/base/paths.h"

namespace fovea::bench {

namespace {

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
        "the default is 1024x1024");
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

void loadPlugins(const std::vector<std::string>& plugins) {
  for (const std::string& plugin : plugins) graph::loadPlugin(plugin);
}

graph::Description loadGraph(const GraphOptions& options, Diagnostics& messages) {
  loadPlugins(options.plugins);
  graph::LoadOptions load;
  for (const std::string& text : options.set) load.overrides.push_back(graph::parseOverride(text));
  load.searchPaths = dataFolders("graphs");
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

}  // namespace fovea::bench
