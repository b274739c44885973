#include "benchmarks/runner/passes.h"
#include "framework/scene/scene.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "benchmarks/runner/baseline/baseline.h"
#include "benchmarks/runner/folder.h"
#include "fovea/scene.h"
#include "framework/base/files.h"
#include "framework/base/random.h"
#include "framework/base/text_file.h"
#include "framework/scene/load.h"
#include "framework/session/graph_run.h"
#include "framework/session/inputs.h"
#include "framework/session/interrupt.h"
#include "framework/session/progress.h"
#include "framework/session/timings.h"

namespace fovea::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr uint32_t kResamples = 4000;
constexpr double kTail = 0.005;  // of the bootstrap interval per side, small since a graph has many passes
constexpr double kResolvedMs = 0.02;  // smaller differences are below the resolution of the clocks
constexpr const char* kFrame = "frame";

// Milliseconds, by repeat and frame.
using Samples = std::vector<std::vector<double>>;

// The settings of a run; only runs with equal settings are compared.
Json describe(const PassBenchOptions& options, const std::string& device) {
  return {{"device", device},   {"graph", options.graph}, {"scene", options.scene},  {"size", options.size},
          {"set", options.set}, {"first", options.first}, {"warmup", options.warmup}};
}

class Bench {
 public:
  explicit Bench(const PassBenchOptions& options)
      : options_(options), progress_(options.quiet || options.json, options.frameLimit) {}
  ExitCode run();

 private:
  void open();
  Json repeat();
  Json fromProgram() const;
  static Json passesOf(const graph::Plan& plan, const std::vector<graph::FrameResult>& frames);
  void printTable(const Json& run) const;
  ExitCode compare(const Json& now, const Json& before) const;

  const PassBenchOptions& options_;
  session::Progress progress_;
  std::shared_ptr<gpu::Device> device_;
  graph::Description description_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  std::string table_;
};

void Bench::open() {
  session::GraphOptions graph;
  graph.graph = options_.graph, graph.set = options_.set, graph.plugins = options_.plugins;
  Diagnostics messages;
  description_ = session::loadGraph(graph, messages);
  progress_.stage("loading scene " + options_.scene);
  scene_ = scene::load(options_.scene, messages);
  geometry_ = scene::flatten(scene_);
  device_ = gpu::openDevice({.device = options_.device, .without = options_.without});
  progress_.clear();
  session::printWarnings(messages);
}

// {"deferred": {"gpu_ms": [..], "cpu_ms": [..], "host": false}, .., "frame": {"gpu_ms", "cpu_ms", "wall_ms"}}.
Json Bench::passesOf(const graph::Plan& plan, const std::vector<graph::FrameResult>& frames) {
  Json passes = Json::object(),
       whole = {{"gpu_ms", Json::array()}, {"cpu_ms", Json::array()}, {"wall_ms", Json::array()}};
  for (const graph::FrameResult& frame : frames) {
    for (const graph::PassTiming& t : frame.passes) {
      const graph::BoundPass& pass = plan.graph->passes[t.pass];
      Json& entry = passes[pass.name];
      entry["gpu_ms"].push_back(t.gpuMs);
      entry["cpu_ms"].push_back(t.cpuMs);
      entry["host"] = pass.declaration->kind == graph::PassKind::Host;
    }
    if (frame.animateMs > 0) {
      passes["animate"]["gpu_ms"].push_back(frame.animateMs);
      passes["animate"]["cpu_ms"].push_back(frame.animateCpuMs);
    }
    whole["gpu_ms"].push_back(frame.gpuMs), whole["cpu_ms"].push_back(frame.cpuMs),
        whole["wall_ms"].push_back(frame.wallMs);
  }
  Json counters = Json::object();
  for (const graph::FrameResult& frame : frames)
    for (const auto& [name, value] : frame.counters) counters[name].push_back(value);
  return {{"passes", passes}, {"frame", whole}, {"counters", counters}};
}

Json Bench::repeat() {
  Diagnostics messages;
  session::GraphRun::Options run;
  run.size = session::parseSize(options_.size);
  run.hostProgress = [this](const std::string& pass, double share) {
    progress_.pass(pass, share);
    return !session::interrupted();
  };
  session::GraphRun graphRun(*device_, description_, scene_, geometry_, std::move(run), messages);
  graphRun.prepare();
  std::vector<graph::FrameResult> frames;
  uint64_t finished = 0;
  const uint64_t total = uint64_t(options_.warmup) + options_.frames;
  const auto take = [&](graph::FrameResult result) {
    progress_.frames(++finished, total);
    if (finished > options_.warmup) frames.push_back(std::move(result));
  };
  progress_.frames(0, total);
  for (uint64_t i = 0; i < total; ++i) {
    if (session::interrupted()) throw Error(ExitCode::Interrupted, "interrupted", "nothing was written");
    graphRun.submit(graphRun.frame(options_.first + i), false);
    if (graphRun.inFlight() == 1) {
      while (auto result = graphRun.executor().next()) take(std::move(*result));
    } else {
      while (auto result = graphRun.executor().poll()) take(std::move(*result));
    }
  }
  while (auto result = graphRun.executor().next()) take(std::move(*result));
  progress_.clear();
  return passesOf(*graphRun.plan(), frames);
}

// One repeat, by another build of this program.
Json Bench::fromProgram() const {
  const auto quoted = [](const std::string& text) {
    std::string safe = "'";
    for (char c : text) safe += c == '\'' ? "'\\''" : std::string(1, c);
    return safe + "'";
  };
  std::string command =
      quoted(fs::absolute(options_.baseline).string()) + " bench passes --json --repeats 1 --graph " +
      quoted(options_.graph) + " --scene " + quoted(options_.scene) + " --size " + quoted(options_.size) +
      fmt::format(" --frames {} --warmup {} --first {}", options_.frames, options_.warmup, options_.first);
  for (const std::string& text : options_.set) command += " --set " + quoted(text);
  if (!options_.device.empty()) command += " --device " + quoted(options_.device);
  for (const std::string& feature : options_.without) command += " --without " + quoted(feature);
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe) {
    char block[4096];
    while (const size_t n = std::fread(block, 1, sizeof block, pipe)) text.append(block, n);
  }
  const int status = pipe ? pclose(pipe) : -1;
  Json run = Json::parse(text, nullptr, false);
  if (status != 0 || !run.is_object() || !run.contains("repeats") || run["repeats"].size() != 1)
    throw Error(ExitCode::BadInput, "the baseline program failed: " + command,
                "name a program `fovea` that has `bench passes`, or a file that -o wrote");
  return run;
}

Samples samplesOf(const Json& run, const std::string& pass, const char* clock) {
  Samples samples;
  for (const Json& repeat : run["repeats"]) {
    const Json& all = pass == kFrame ? repeat["frame"] : repeat["passes"].value(pass, Json::object());
    if (all.contains(clock)) samples.push_back(all[clock].get<std::vector<double>>());
  }
  return samples;
}

std::vector<double> flat(const Samples& samples) {
  std::vector<double> all;
  for (const auto& repeat : samples) all.insert(all.end(), repeat.begin(), repeat.end());
  return all;
}

std::vector<std::string> passNames(const Json& run) {
  std::vector<std::string> names;
  for (const auto& [name, times] : run["repeats"][0]["passes"].items()) names.push_back(name);
  return names;
}

// The clock of the device on which the pass works.
const char* clockOf(const Json& run, const std::string& pass) {
  if (pass == kFrame) return "wall_ms";
  return run["repeats"][0]["passes"][pass].value("host", false) ? "cpu_ms" : "gpu_ms";
}

void Bench::printTable(const Json& run) const {
  std::vector<std::string> names = passNames(run);
  names.push_back(kFrame);
  size_t width = 5;
  for (const std::string& name : names) width = std::max(width, name.size());
  fmt::print("{} on {}, {}\n{}, {} x {} frames\n\n", options_.graph, options_.scene, options_.size,
             device_->name(), options_.repeats, options_.frames);
  fmt::print("{:<{}} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "pass", width, "gpu ms", "min", "p95",
             "cpu ms", "min", "p95");
  for (const std::string& name : names) {
    const session::Spread gpu = session::spreadOf(flat(samplesOf(run, name, "gpu_ms"))),
                          cpu = session::spreadOf(flat(samplesOf(run, name, "cpu_ms")));
    fmt::print("{:<{}} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, width,
               gpu.median, gpu.min, gpu.p95, cpu.median, cpu.min, cpu.p95);
  }
  const session::Spread wall = session::spreadOf(flat(samplesOf(run, kFrame, "wall_ms")));
  fmt::print("wall time of a frame: {:.3f} ms (min {:.3f}, p95 {:.3f})\n", wall.median, wall.min, wall.p95);
  const Json& counters = run["repeats"][0]["counters"];
  if (!counters.empty()) fmt::print("\ncounters of a frame, which do not depend on the machine\n");
  for (const auto& [name, values] : counters.items())
    fmt::print("  {:<32} {:>14.6g}\n", name, session::spreadOf(values.get<std::vector<double>>()).median);
}

// ---- Comparison

struct Change {
  double before = 0, now = 0;  // medians, ms
  double low = 0, high = 0;    // interval of now / before
};

double medianOfMedians(const Samples& samples, uint32_t stream, uint32_t& draw) {
  std::vector<double> medians;
  for (size_t i = 0; i < samples.size(); ++i) {
    const auto pick = [&](size_t n) {
      return std::min(n - 1, size_t(uniformFloat(hashCombine(stream, draw++)) * float(n)));
    };
    const std::vector<double>& repeat = samples[pick(samples.size())];  // whole repeats, then frames of each
    std::vector<double> frames;
    for (size_t f = 0; f < repeat.size(); ++f) frames.push_back(repeat[pick(repeat.size())]);
    medians.push_back(session::spreadOf(std::move(frames)).median);
  }
  return session::spreadOf(std::move(medians)).median;
}

// Hierarchical bootstrap (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter 13: percentile
// interval). What differs between repeats, such as the placement of memory, counts once per repeat.
Change changeOf(const Samples& before, const Samples& now) {
  Change change;
  change.before = session::spreadOf(flat(before)).median, change.now = session::spreadOf(flat(now)).median;
  std::vector<double> ratios;
  uint32_t draw = 0;
  for (uint32_t i = 0; i < kResamples; ++i) {
    const double b = medianOfMedians(before, 1, draw), n = medianOfMedians(now, 2, draw);
    if (b > 0) ratios.push_back(n / b);
  }
  if (ratios.empty()) return {change.before, change.now, 1, 1};
  std::sort(ratios.begin(), ratios.end());
  const auto at = [&](double share) {
    return ratios[std::min(ratios.size() - 1, size_t(share * double(ratios.size())))];
  };
  change.low = at(kTail), change.high = at(1 - kTail);
  return change;
}

ExitCode Bench::compare(const Json& now, const Json& before) const {
  std::vector<std::string> names = passNames(now);
  names.push_back(kFrame);
  size_t width = 5;
  for (const std::string& name : names) width = std::max(width, name.size());
  fmt::print("\n{:<{}} {:>11} {:>11} {:>9}   {:<17}\n", "pass", width, "baseline ms", "now ms", "change",
             "99% interval");
  bool slower = false;
  for (const std::string& name : names) {
    const char* clock = clockOf(now, name);
    const Samples old = samplesOf(before, name, clock);
    if (flat(old).empty()) {
      fmt::print("{:<{}} {:>11} {:>11.3f}            new\n", name, width, "-",
                 session::spreadOf(flat(samplesOf(now, name, clock))).median);
      continue;
    }
    const Change c = changeOf(old, samplesOf(now, name, clock));
    const double margin = options_.threshold / 100;
    const bool resolved = std::abs(c.now - c.before) > kResolvedMs;
    const char* verdict = resolved && c.low > 1 + margin    ? "SLOWER"
                          : resolved && c.high < 1 - margin ? "faster"
                                                            : "";
    slower |= *verdict == 'S';
    fmt::print("{:<{}} {:>11.3f} {:>11.3f} {:>+8.1f}%   {:>+6.1f}% .. {:>+6.1f}%  {}\n", name, width,
               c.before, c.now, c.before > 0 ? 100 * (c.now / c.before - 1) : 0, 100 * (c.low - 1),
               100 * (c.high - 1), verdict);
  }
  for (const std::string& name : passNames(before))
    if (!now["repeats"][0]["passes"].contains(name)) fmt::print("{:<{}} is gone\n", name, width);
  for (const auto& [name, values] : now["repeats"][0]["counters"].items()) {
    const Json& old = before["repeats"][0]["counters"].value(name, Json());
    if (old.is_array() && old != values)
      fmt::print("counter {}: {:.6g} before, {:.6g} now\n", name,
                 session::spreadOf(old.get<std::vector<double>>()).median,
                 session::spreadOf(values.get<std::vector<double>>()).median);
  }
  return slower ? ExitCode::Slower : ExitCode::Ok;
}

ExitCode Bench::run() {
  const bool isProgram = !options_.baseline.empty() && fs::path(options_.baseline).extension() != ".json" &&
                         access(options_.baseline.c_str(), X_OK) == 0;
  Json before;
  if (!options_.baseline.empty() && !isProgram) before = readBaseline(options_.baseline);
  if (!options_.output.empty()) checkTextWritable(options_.output);
  open();
  session::catchInterrupts();
  if (!options_.output.empty()) checkOutputs({options_.output});
  Json now = {{"with", describe(options_, device_->name())}, {"repeats", Json::array()}};
  if (!before.is_null()) {
    const std::string other = firstDifference(before["with"], now["with"]);
    if (!other.empty())
      throw Error(ExitCode::BadInput,
                  "the baseline `" + options_.baseline + "` was measured otherwise: " + other,
                  "measure with the same options");
  }
  for (uint32_t i = 0; i < options_.repeats; ++i) {
    progress_.setPrefix(fmt::format("repeat {}/{}: ", i + 1, options_.repeats));
    // Alternates, so that a temporary slowdown of the machine affects both.
    if (isProgram) {
      Json other = fromProgram();
      if (before.is_null()) before = {{"with", other["with"]}, {"repeats", Json::array()}};
      before["repeats"].push_back(other["repeats"][0]);
    }
    now["repeats"].push_back(repeat());
  }
  progress_.setPrefix("");
  if (!options_.output.empty()) writeText(options_.output, now.dump() + "\n");
  if (options_.json) fmt::print("{}\n", now.dump());
  if (!options_.json && !options_.quiet) printTable(now);
  return before.is_null() ? ExitCode::Ok : compare(now, before);
}

}  // namespace

ExitCode benchPasses(const PassBenchOptions& given) {
  PassBenchOptions options = given;
  if (options.size.empty()) options.size = "1024x1024";
  return Bench(options).run();
}

}  // namespace fovea::bench
