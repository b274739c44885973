// A trace of the run in Chrome's trace event format: opens in Perfetto (ui.perfetto.dev) and
// chrome://tracing.
#pragma once

#include <string>

#include "benchmarks/runner/timings.h"
#include "samples/fovea/arguments.h"

namespace fovea::cli {

// Two tracks, GPU and CPU, with a slice per frame and, inside, a slice per pass; counters as counter tracks.
// The executor reports durations, not starting points, so the slices of a frame stand one after the other
// from the frame's start.
std::string chromeTrace(const Timings& timings, const RunInfo& run);

}  // namespace fovea::cli
