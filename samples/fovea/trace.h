// Writes a trace of the run in Chrome's trace event format, which Perfetto (ui.perfetto.dev)
// and chrome://tracing open.
#pragma once

#include <string>

#include "framework/session/timings.h"
#include "samples/fovea/arguments.h"

namespace fovea::cli {

// Makes two tracks, GPU and CPU, with one slice per frame that contains one slice per pass; counters become
// counter tracks. The executor reports durations but no starting times, so the slices of a frame follow one
// another from its start.
std::string chromeTrace(const Timings& timings, const RunInfo& run);

}  // namespace fovea::cli
