// A benchmark suite: scenes x graphs x parameters x frames x measures, read from JSON and written out into
// jobs. Knows nothing of devices, passes or scenes: names are checked by whoever runs the jobs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"

namespace fovea::bench {

// A job whose parameter is searched for (bisection over whole numbers, logarithmic) until `measure` is no
// greater than that of the graph `like` of the same sweep, scene, parameters and seed.
struct Match {
  std::string parameter = "vpl_count", like, measure = "error.fovea.mse";
  uint32_t from = 250, to = 16000;
  std::string likeGraph;                                     // file or name behind the label `like`
  std::vector<std::pair<std::string, std::string>> likeSet;  // its parameters
  uint32_t likeWarmup = 0;
};

// What is measured, and everything that decides what comes out.
struct Job {
  std::string sweep, scene, graph, label;                // label: what tables call the graph
  std::vector<std::pair<std::string, std::string>> set;  // graph parameters
  std::vector<std::pair<std::string, std::string>>
      varied;  // those of `set`, and `size` and `frame_rate`, that the sweep varies
  glm::uvec2 size{256};
  uint32_t first = 40, frames = 1, warmup = 0, seed = 1;
  double frameRate = 42;
  uint32_t spp = 512, depth = 4;                           // of the reference
  bool error = false, temporal = false, pictures = false;  // times and counters are always measured
  std::string layer = "radiance";                          // that is compared; or "indirect"
  std::optional<Match> match;
  SourceLocation sceneWhere, graphWhere;
  bool sceneOptional = false;

  // For files and --only: "stills-cornellbox-ours-vpl_count=250-s1".
  std::string name() const;
  bool needsReference() const { return error || temporal; }
  nlohmann::ordered_json json() const;  // all but places; equal jobs have equal texts
};

// One derived number: how many times as long a frame of `over` takes as one of `of` (labels).
struct SpeedUp {
  std::string sweep, of;
  std::vector<std::string> over;
};

struct Suite {
  std::string name, description,
      paper;              // paper: table of benchmarks/paper.json whose numbers stand beside ours
  std::vector<Job> jobs;  // by scene, so that one is loaded once
  std::vector<SpeedUp> speedUps;
  std::filesystem::path file;
};

struct SuiteOverrides {
  std::optional<glm::uvec2> size;  // of every job that does not vary it
  std::optional<uint32_t> seeds;
};

// Throws Error(BadInput) with every mistake of the file and its place.
Suite parseSuite(std::string_view text, const std::filesystem::path& file,
                 const SuiteOverrides& overrides = {});
// A file, or a bare name looked up in `folders`. Throws Error(BadInput) listing what there is.
Suite loadSuite(const std::string& nameOrFile, const std::vector<std::filesystem::path>& folders,
                const SuiteOverrides& overrides = {});

// `*` and `?`; a pattern without them matches any part of the name.
bool matchesGlob(std::string_view pattern, std::string_view name);

}  // namespace fovea::bench
