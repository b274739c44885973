#include "framework/session/graph_run.h"

#include <fmt/format.h>

#include "framework/gpu/format.h"
#include "framework/graph/pass/registry.h"
#include "framework/graph/report/report.h"
#include "framework/scene/fovea.h"
#include "framework/scene/motion/motion.h"

namespace fovea::session {

bool raysOnHost(RaysOn rays, const gpu::Device* device) {
  return rays == RaysOn::Auto ? !device || device->isCpu() : rays == RaysOn::Host;
}

graph::Environment sceneEnvironment(const gpu::Device* device, const scene::Scene& scene,
                                    const scene::Geometry& geometry, glm::uvec2 size, RaysOn rays,
                                    const std::optional<glm::uvec2>& inset) {
  graph::Environment environment = graph::deviceEnvironment(device);
  environment.raysOnHost = raysOnHost(rays, device);
  const glm::uvec2 small = inset.value_or(size);
  environment.views = scene::frameViews({size.x, size.y}, {small.x, small.y});
  environment.quantities = scene::quantities(scene, geometry);
  environment.texts.emplace_back("scene.materials", scene.fullMaterials ? "full" : "diffuse");
  environment.texts.emplace_back("scene.environment", scene.environmentMap ? "map" : "none");
  return environment;
}

double parameterOr(const graph::BoundGraph& graph, const char* name, double otherwise) {
  double value = otherwise;
  for (const graph::BoundPass& pass : graph.passes)
    if (pass.parameters.find(name)) value = pass.parameters.real(name);
  return value;
}

image::Image toImage(const graph::OutputData& output) {
  return {output.desc.width, output.desc.height, gpu::formatInfo(output.desc.format).channels,
          gpu::texelsToFloats(output.desc.format, output.bytes)};
}

namespace {

// Where the scene has to have what rays meet. A pass that traces rays in none of its declared steps does so in kernels
// of its own, on the device.
scene::RaysWanted raysOf(const graph::Plan& plan) {
  scene::RaysWanted rays;
  const std::vector<graph::BoundPass>& passes = plan.graph->passes;
  for (size_t i = 0; i < passes.size(); ++i) {
    if (!plan.passLive[i] || !passes[i].declaration->tracesRays) continue;
    bool any = false;
    for (const graph::PlannedStep& step : plan.steps[i]) {
      if (!step.tracesRays) continue;
      any = true;
      (step.host ? rays.host : rays.device) = true;
    }
    rays.device |= !any;
  }
  return rays;
}

// Parts of graphs have inputs that the graph around them wires.
void refuseInputs(const graph::Description& description) {
  Diagnostics messages;
  for (const graph::ExternalDescription& input : description.externals)
    messages.error(
        input.where.location(), "inputs." + input.name,
        fmt::format("graph `{}` cannot run alone: nothing fills its input `{}`", description.name,
                    input.name),
        fmt::format("run a graph with a pass {{\"graph\": \"{}.json\", \"inputs\": ...}}", description.name));
  messages.throwIfErrors();
}

}  // namespace

GraphRun::GraphRun(gpu::Device& device, const graph::Description& description, const scene::Scene& scene,
                   scene::Geometry& geometry, Options options, Diagnostics& messages)
    : device_(device), scene_(scene), geometry_(geometry), options_(std::move(options)) {
  if (!options_.givesInputs) refuseInputs(description);
  const glm::uvec2 size = options_.size;
  const uint32_t limit = device_.limits().maxImageDimension2D;
  if (size.x > limit || size.y > limit)
    throw Error(ExitCode::Usage,
                fmt::format("a picture of {}x{} pixels exceeds this device's largest image of {} a side",
                            size.x, size.y, limit),
                "render a smaller picture");
  graph::BoundGraph made = graph::bind(
      description, sceneEnvironment(&device_, scene_, geometry_, size, options_.rays, options_.inset),
      messages);
  graph::replaceFormats(device_, made);
  graph::shareWithHost(device_, made);
  for (graph::BoundResource& resource : made.resources) resource.observable = options_.observable;
  auto bound = std::make_shared<const graph::BoundGraph>(std::move(made));
  if (options_.readback) readback_ = options_.readback(*bound);
  plan_ =
      std::make_shared<const graph::Plan>(graph::compile(bound, graph::deviceCompileOptions(device_, bound)));
  graph::warnAboutPlan(*plan_, messages);
}

void GraphRun::prepare(GraphRun* before, bool keepContents) {
  inFlight_ = options_.framesInFlight > 0 ? options_.framesInFlight : device_.isCpu() ? 1 : 2;
  if (before && (&before->scene_ != &scene_ || before->inFlight_ != inFlight_)) before = nullptr;
  const bool full = graph().view.text("materials") == "full";
  const scene::RaysWanted rays = raysOf(*plan_);
  const bool sameScene =
      before && before->gpuScene_->fullMaterials() == full && before->gpuScene_->rays() == rays;
  gpuScene_ = sameScene
                  ? before->gpuScene_
                  : std::make_shared<scene::GpuScene>(device_, scene_, geometry_, inFlight_, full, rays);
  graph::ExecutorOptions executorOptions;
  executorOptions.framesInFlight = inFlight_;
  executorOptions.readback = readback_;
  executorOptions.hostProgress = options_.hostProgress;
  executorOptions.countOperations = options_.countOperations;
  executorOptions.keepContents = keepContents && sameScene;  // what passes keep was made of the scene
  executor_ = std::make_unique<graph::Executor>(device_, plan_, graph::Registry::global(), *gpuScene_,
                                                executorOptions, before ? before->executor_.get() : nullptr);
}

scene::Frame GraphRun::frame(uint64_t index) const {
  return frame(scene::momentAt(scene_, index, options_.frameRate));
}

scene::Frame GraphRun::frame(const scene::Moment& moment) const {
  const uint64_t index = moment.index;
  scene::Frame f = scene::makeFrame(scene_, geometry_, options_.size, moment, options_.seed, options_.inset);
  f.gpu = gpuScene_.get();
  const graph::Parameters& set = graph().view;
  const float angle = glm::radians(float(set.real("fovea_degrees")));
  const auto places = uint32_t(set.integer("jitter"));
  const glm::vec2 now = scene::jitterAt(index, places);
  const glm::vec2 before = f.cameraCut ? now : scene::jitterAt(index - 1, places);
  for (scene::View& view : f.views) {
    view.foveaRadius =
        angle > 0 ? scene::foveaRadiusOfAngle(angle, view.viewToClip) : float(set.real("fovea_radius"));
    view.pixelsPerDegree = float(set.real("pixels_per_degree"));
  }
  // The fovea of an inset is that of the picture around it, which is wider.
  for (size_t i = 0; i < std::size(scene::kInsets) && !(angle > 0); ++i) {
    scene::View& inset = f.views[scene::kInsets[i]];
    const scene::View& around = f.views[scene::kInsetEyes[i]];
    inset.foveaRadius *= inset.viewToClip[0][0] / around.viewToClip[0][0];
  }
  for (scene::View& view : f.views) scene::jitter(view, now, before);
  return f;
}

void GraphRun::submit(const scene::Frame& frame, bool readOutputs, bool observe,
                      std::span<const graph::OutputCopy> copies) {
  if (executor_->readsGeometry()) scene::moveObjects(frame, geometry_);
  executor_->submit(frame, readOutputs, observe, copies);
}

}  // namespace fovea::session
