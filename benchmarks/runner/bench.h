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
  bool serve = false;  // measures the jobs whose names arrive on standard input; see runSuite()
};

// With `serve`, it reads names of jobs from standard input, one a line, and answers each with a line on standard output:
// "done NAME" when its result is in the folder, or "missing NAME" if its optional scene is not there. At the end of the
// input it ends, without tables or report.
//
// Reports its progress on the terminal. Throws Error(Usage) on options that contradict each other, Error(BadInput) on
// a suite, graph or scene that cannot be used, and Error(Interrupted) after Ctrl-C.
ExitCode runSuite(const SuiteOptions& options);

}  // namespace fovea::bench
