#include "samples/fovea/trace.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/graph/compile/plan.h"

namespace fovea::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kGpuTrack = 1, kCpuTrack = 2;

Json trackName(int track, const char* name) {
  return {{"ph", "M"}, {"pid", 1}, {"tid", track}, {"name", "thread_name"}, {"args", {{"name", name}}}};
}

// Times in milliseconds; the format counts microseconds.
Json slice(const std::string& name, const char* category, int track, double start, double duration,
           Json arguments) {
  return {{"ph", "X"},
          {"pid", 1},
          {"tid", track},
          {"name", name},
          {"cat", category},
          {"ts", start * 1000.0},
          {"dur", duration * 1000.0},
          {"args", std::move(arguments)}};
}

void addTrack(Json& events, const Timings& timings, const graph::FrameResult& frame, int track,
              double start) {
  const auto time = [&](const graph::PassTiming& t) { return track == kGpuTrack ? t.gpuMs : t.cpuMs; };
  double sum = 0;
  for (const graph::PassTiming& t : frame.passes) sum += time(t);
  const double duration = std::max(sum, track == kGpuTrack ? frame.gpuMs : frame.cpuMs);
  const Json number = {{"frame", frame.frame}};
  events.push_back(slice("frame " + std::to_string(frame.frame), "frame", track, start, duration, number));
  for (const graph::PassTiming& t : frame.passes) {
    if (time(t) <= 0) continue;
    events.push_back(
        slice(timings.name(t.pass), "pass", track, start, time(t), {{"type", timings.type(t.pass)}}));
    double stepStart = start;
    for (const graph::StepTiming& step : t.steps) {
      if (track != kGpuTrack || t.steps.size() == 1) break;
      events.push_back(
          slice(step.name, "step", track, stepStart, step.gpuMs, {{"pass", timings.name(t.pass)}}));
      stepStart += step.gpuMs;
    }
    start += time(t);
  }
}

}  // namespace

std::string chromeTrace(const Timings& timings, const RunInfo& run) {
  Json events = Json::array();
  events.push_back({{"ph", "M"}, {"pid", 1}, {"name", "process_name"}, {"args", {{"name", "fovea"}}}});
  events.push_back(trackName(kGpuTrack, "GPU"));
  events.push_back(trackName(kCpuTrack, "CPU"));
  double start = 0;
  timings.eachFrame([&](const graph::FrameResult& frame) {
    addTrack(events, timings, frame, kGpuTrack, start);
    addTrack(events, timings, frame, kCpuTrack, start);
    for (const auto& [name, value] : frame.counters)
      events.push_back(
          {{"ph", "C"}, {"pid", 1}, {"name", name}, {"ts", start * 1000.0}, {"args", {{"value", value}}}});
    start += std::max({frame.wallMs, frame.gpuMs, frame.cpuMs});
  });
  const Json document = {
      {"traceEvents", events},
      {"displayTimeUnit", "ms"},
      {"otherData",
       {{"device", run.device}, {"graph", run.graph}, {"graph_hash", run.graphHash}, {"scene", run.scene}}},
  };
  return document.dump() + '\n';
}

}  // namespace fovea::cli
