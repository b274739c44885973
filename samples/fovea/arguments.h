// Options that several commands share, and what their texts mean.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/diagnostic.h"
#include "framework/graph/compile.h"
#include "framework/scene/scene.h"

namespace fovea::cli {

inline constexpr uint32_t kMaxSize = 16384;   // pixels a side: what Vulkan devices promise at most
inline constexpr double kFoveaRadius = 0.25;  // image widths, where nothing says otherwise

struct GraphOptions {
  std::string graph;
  std::vector<std::string> set, plugins;
};

void addPluginOption(CLI::App& command, std::vector<std::string>& plugins);
void addGraphOptions(CLI::App& command, GraphOptions& options);  // GRAPH, --set, --plugin
// For an option that may be given several times, each time with one value.
CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                     const std::string& doc);

// "1024x768". Throws Error(Usage) naming the limits.
glm::uvec2 parseSize(std::string_view text);
// "0.5,0.4": normalised image coordinates, origin top-left. Throws Error(Usage).
glm::vec2 parseGaze(std::string_view text);
// "55,45,50,52": degrees outwards, inwards, up, down. Throws Error(Usage).
scene::Lens parseLens(std::string_view text);

void loadPlugins(const std::vector<std::string>& plugins);
// The plug-ins, then the graph with its overrides; mistakes inside the file go to `messages`, and bind()
// throws them.
graph::Description loadGraph(const GraphOptions& options, Diagnostics& messages);

// Warnings and notes to stderr, each text once in the life of the process.
void printWarnings(const Diagnostics& messages);

std::string formatHash(uint64_t hash);  // 16 hexadecimal digits
// Names as a list for messages: "`a`, `b`".
std::string quoteList(const std::vector<std::string>& names);

}  // namespace fovea::cli
