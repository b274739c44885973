// The command `fovea bench passes`: measures what the passes of one graph cost and whether that has changed.
#pragma once

#include <string>
#include <vector>

#include "framework/session/progress.h"

namespace fovea::bench {

struct PassBenchOptions {
  std::string graph, scene, baseline;
  std::vector<std::string> set;
  uint32_t frames = 5, warmup = 3, first = 0, repeats = 5;
  double threshold = 2;  // percent
  double frameLimit = session::kFrameLimit;
  bool json = false;
  std::string output, size, device;  // as the suite's options of the same names
  std::vector<std::string> plugins, without;
  bool quiet = false;
};

ExitCode benchPasses(const PassBenchOptions& options);

}  // namespace fovea::bench
