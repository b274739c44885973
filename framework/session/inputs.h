// Parses what users name on a command line or in a suite: sizes, gazes, graphs and plug-ins.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"
#include "fovea/scene.h"
#include "framework/graph/compile/compile.h"
#include "framework/session/graph_run.h"

namespace fovea::session {

inline constexpr uint32_t kMaxSize = 16384;   // pixels per side
inline constexpr double kFoveaRadius = 0.25;  // image widths, the default

struct GraphOptions {
  std::string graph;
  std::vector<std::string> set, plugins;
  std::vector<std::string> passes;  // folders of pass files
  session::RaysOn rays = session::RaysOn::Auto;
};

// Parses "1024x768". Throws Error(Usage) naming the limits.
glm::uvec2 parseSize(std::string_view text);
// Parses "0.5,0.4" in normalised image coordinates with the origin at the top left. Throws Error(Usage).
glm::vec2 parseGaze(std::string_view text);

// Parses "55,45,50,52": degrees outwards, inwards, up and down. Throws Error(Usage).
scene::Lens parseLens(std::string_view text);

// Replaces each folder, written with a slash ("mine/") as other names are bare ones, by the scene files (.json) in it,
// in alphabetical order. Throws Error(BadInput) if there are none, and Error(Usage) if two scenes are called the same, as
// results are named after them.
std::vector<std::string> sceneNames(const std::vector<std::string>& filesAndFolders);

void loadPlugins(const std::vector<std::string>& plugins);
// Loads the pass files of the folders that FOVEA_PASSES names and of these.
void loadPassFolders(const std::vector<std::string>& folders);
// Loads the plug-ins and passes, among them those of a folder `passes` beside the graph, then the graph with its
// overrides. Mistakes inside the file are collected in `messages`; bind() throws them.
graph::Description loadGraph(const GraphOptions& options, Diagnostics& messages);

// Writes warnings and notes to stderr, each text once per process.
void printWarnings(const Diagnostics& messages);

std::string formatHash(uint64_t hash);  // 16 hexadecimal digits
// Names as a list for messages: "`a`, `b`".
std::string quoteList(const std::vector<std::string>& names);

}  // namespace fovea::session
