// Runs a suite of measurements job by job and writes results, tables and a report.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/session/progress.h"

namespace fovea::bench {

struct SuiteOptions {
  std::string suite, folder, cache, only, shard, size, scale, device;
  std::optional<uint32_t> seeds;
  double frameLimit = session::kFrameLimit;
  std::vector<std::string> scenes, plugins, without;
  bool resume = false, replace = false, report = false, list = false, quiet = false, referencesOnly = false;
};

// Reports its progress on the terminal. Throws Error(Usage) on options that contradict each other, Error(BadInput) on
// a suite, graph or scene that cannot be used, and Error(Interrupted) after Ctrl-C.
ExitCode runSuite(const SuiteOptions& options);

}  // namespace fovea::bench
