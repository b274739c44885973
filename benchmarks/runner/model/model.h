// The command `fovea bench model`: the least time that a device of some kind needs for each pass of a graph, beside the
// time that was measured on the device at hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/session/inputs.h"
#include "framework/session/progress.h"

namespace fovea::bench {

struct ModelOptions {
  session::GraphOptions graph;
  std::string scene, size = "1024x1024", kind = "headset";
  std::optional<double> bandwidth, flops, rayRate;  // GB/s, TFLOP/s and Grays/s, instead of those of the kind
  uint32_t frames = 5, warmup = 3, first = 0, seed = 1;
  std::string json;    // a file to write; "" for none
  std::string device;  // on which is measured
  std::vector<std::string> without;
  double frameLimit = session::kFrameLimit;
  bool quiet = false;
};

// Renders the frames twice, the second time with shaders that count their operations. Throws Error(Usage) on an unknown
// kind, and as GraphRun does.
ExitCode benchModel(const ModelOptions& options);

}  // namespace fovea::bench
