// A benchmark suite: scenes x graphs x parameters x frames x measures, read from JSON and expanded into jobs. It
// knows nothing of devices, passes or scenes; whatever runs the jobs checks the names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"

namespace fovea::bench {

// A search for the value of a parameter (bisection over whole numbers, logarithmic) at which `measure` is no greater
// than that of the graph `like` in the same sweep with the same scene, parameters and seed.
struct Match {
  std::string parameter = "vpl_count", like, measure = "error.fovea.mse";
  uint32_t from = 250, to = 16000;
  std::string likeGraph;                                     // file or name behind the label `like`
  std::vector<std::pair<std::string, std::string>> likeSet;  // its parameters
  uint32_t likeWarmup = 0;
};

// What is measured, and everything on which the result depends.
struct Job {
  std::string sweep, scene, graph, label;                // label: name of the graph in tables
  std::vector<std::pair<std::string, std::string>> set;  // graph parameters
  // What the sweep varies: parameters of `set`, `size` and `frame_rate`.
  std::vector<std::pair<std::string, std::string>> varied;
  glm::uvec2 size{256};
  uint32_t first = 40, frames = 1, warmup = 0, seed = 1;
  double frameRate = 42;
  uint32_t spp = 512, depth = 4;  // of the reference
  // Times and counters are always measured.
  bool error = false, temporal = false, eyes = false, pictures = false;
  std::string layer = "radiance";  // the layer that is compared; or "indirect"
  std::optional<Match> match;
  SourceLocation sceneWhere, graphWhere;
  bool sceneOptional = false;

  // Name for files and --only, such as "stills-cornellbox-ours-vpl_count=250-s1".
  std::string name() const;
  bool needsReference() const { return error || temporal || eyes; }
  nlohmann::ordered_json json() const;  // without places in files; equal jobs have equal texts
};

// A derived number: the time of a frame of `over` divided by that of `of` (labels).
struct SpeedUp {
  std::string sweep, of;
  std::vector<std::string> over;
};

struct Suite {
  std::string name, description;
  std::string page;       // script in benchmarks/ that writes a page of its own, or ""
  std::vector<Job> jobs;  // grouped by scene, so that each is loaded once
  std::vector<SpeedUp> speedUps;
  std::map<std::string, std::string> papers;  // sweep -> table of benchmarks/paper.json to show beside it
  std::vector<std::string> scales;            // their names
  std::string scale;                          // the one that was chosen, or ""
  std::filesystem::path file;
};

struct SuiteOverrides {
  std::optional<glm::uvec2> size;  // for every job that does not vary its size
  std::optional<uint32_t> seeds;
  std::vector<std::string> scenes;  // for every sweep, if there are any
  std::string scale;                // one of the suite's, or ""; what is given above takes precedence over it
};

// Throws Error(BadInput) with every mistake in the file and its place, and Error(Usage) if there is no such scale.
Suite parseSuite(std::string_view text, const std::filesystem::path& file,
                 const SuiteOverrides& overrides = {});
// Loads a file, or a bare name that is looked up in `folders`. Throws Error(BadInput) listing the suites that exist.
Suite loadSuite(const std::string& nameOrFile, const std::vector<std::filesystem::path>& folders,
                const SuiteOverrides& overrides = {});

// Matches wildcards as fnmatch(3) does; a pattern without `*` and `?` matches any part of the name.
bool matchesGlob(std::string_view pattern, std::string_view name);

}  // namespace fovea::bench
