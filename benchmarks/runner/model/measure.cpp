#include "benchmarks/runner/model/measure.h"

#include <algorithm>

#include "framework/base/files.h"
#include "framework/scene/load.h"
#include "framework/session/graph_run.h"
#include "framework/session/interrupt.h"
#include "framework/session/timings.h"

namespace fovea::bench {
namespace {

using Frames = std::vector<graph::FrameResult>;

template <class Get>
double medianOver(const Frames& frames, const Get& get) {
  std::vector<double> values;
  for (const graph::FrameResult& frame : frames) values.push_back(get(frame));
  return session::spreadOf(std::move(values)).median;
}

// A pass counts its rays in a counter of that name.
double raysOf(const graph::FrameResult& frame, const std::string& pass) {
  const auto found =
      std::ranges::find(frame.counters, pass + ".rays", &std::pair<std::string, double>::first);
  return found == frame.counters.end() ? 0 : found->second;
}

// Where a pass runs steps on the host, the device waits for them, which is not part of its own time.
double timeOf(const graph::BoundGraph& graph, const graph::PassTiming& timing) {
  const graph::PassDeclaration& declaration = *graph.passes[timing.pass].declaration;
  if (declaration.kind == graph::PassKind::Host) return timing.cpuMs;
  return timing.gpuMs + (declaration.tracesRays && graph.raysOnHost ? timing.cpuMs : 0);
}

class Measurement {
 public:
  explicit Measurement(const ModelOptions& options)
      : options_(options), progress_(options.quiet, options.frameLimit) {}
  FrameFigures run();

 private:
  void open();
  Frames render(bool countOperations);

  const ModelOptions& options_;
  session::Progress progress_;
  std::shared_ptr<gpu::Device> device_;
  graph::Description description_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  Diagnostics messages_;
  std::shared_ptr<const graph::Plan> plan_;
};

void Measurement::open() {
  description_ = session::loadGraph(options_.graph, messages_);
  progress_.stage("loading scene " + options_.scene);
  scene_ = scene::load(options_.scene, messages_);
  geometry_ = scene::flatten(scene_);
  device_ = gpu::openDevice({.device = options_.device, .without = options_.without});
  session::catchInterrupts();
  if (!options_.json.empty()) checkOutputs({options_.json});
}

// The frames after the warm-up.
Frames Measurement::render(bool countOperations) {
  progress_.setPrefix(countOperations ? "counting operations: " : "measuring: ");
  session::GraphRun::Options run;
  run.size = session::parseSize(options_.size);
  run.seed = options_.seed;
  run.rays = options_.graph.rays;
  run.countOperations = countOperations;
  run.hostProgress = [this](const std::string& pass, double share) {
    progress_.pass(pass, share);
    return !session::interrupted();
  };
  session::GraphRun graphRun(*device_, description_, scene_, geometry_, std::move(run), messages_);
  graphRun.prepare();
  plan_ = graphRun.plan();
  Frames frames;
  const uint64_t total = uint64_t(options_.warmup) + options_.frames;
  uint64_t finished = 0;
  const auto take = [&](bool all) {
    while (auto result = all ? graphRun.executor().next() : graphRun.executor().poll()) {
      progress_.frames(++finished, total);
      if (finished > options_.warmup) frames.push_back(std::move(*result));
    }
  };
  for (uint64_t i = 0; i < total; ++i) {
    if (session::interrupted()) throw Error(ExitCode::Interrupted, "interrupted", "nothing was written");
    graphRun.submit(graphRun.frame(options_.first + i), false);
    take(graphRun.inFlight() == 1);
  }
  take(true);
  progress_.clear();
  return frames;
}

FrameFigures Measurement::run() {
  open();
  const Frames frames = render(false), counted = render(true);
  session::printWarnings(messages_);
  FrameFigures figures{plan_, scene_.name, device_->name(), {}, 0, 0};
  const graph::BoundGraph& graph = *plan_->graph;
  const std::vector<graph::PassTraffic> traffic = graph::traffic(*plan_);
  for (size_t i = 0; i < frames.back().passes.size(); ++i) {
    PassFigures& pass = figures.passes.emplace_back();
    pass.pass = frames.back().passes[i].pass;
    pass.commands = frames.back().passes[i].commands;
    pass.traffic = traffic[pass.pass];
    pass.operations =
        medianOver(counted, [&](const auto& frame) { return double(frame.passes[i].operations); });
    pass.rays =
        medianOver(frames, [&](const auto& frame) { return raysOf(frame, graph.passes[pass.pass].name); });
    pass.ms = medianOver(frames, [&](const auto& frame) { return timeOf(graph, frame.passes[i]); });
  }
  figures.wallMs = medianOver(frames, [](const auto& frame) { return frame.wallMs; });
  figures.gpuMs = medianOver(frames, [](const auto& frame) { return frame.gpuMs; });
  return figures;
}

}  // namespace

FrameFigures measureFrame(const ModelOptions& options) { return Measurement(options).run(); }

}  // namespace fovea::bench
