#include "samples/fovea/vr/application.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "framework/base/files.h"
#include "framework/base/text_file.h"
#include "framework/graph/report/report.h"
#include "framework/scene/load.h"
#include "framework/scene/motion/motion.h"
#include "framework/scene/scene.h"
#include "framework/session/head_trace.h"
#include "framework/session/interrupt.h"

namespace fovea::vr {
namespace {

// What the graphs for two eyes call the pictures of their views, in the order of viewNames().
constexpr const char* kOutputs[] = {"image", "image_right", "image_inset", "image_right_inset"};
constexpr auto kPause = std::chrono::milliseconds(5);  // while no frames are due

bool hasView(const graph::BoundGraph& graph, const char* name) {
  return std::ranges::find(graph.views, name) != graph.views.end();
}

uint32_t scaled(uint32_t pixels, double factor) {
  return std::clamp(uint32_t(std::lround(pixels * factor)), 1u, session::kMaxSize);
}

}  // namespace

Application::Application(const Options& options)
    : options_(options),
      progress_(false, options.frameLimit),
      watchdog_(std::chrono::duration<double>(options.frameLimit), ExitCode::DeviceLost,
                session::frameLimitMessage(options.frameLimit)) {
  std::vector<std::filesystem::path> files;
  for (const std::string& file : {options.record, options.log, options.timings})
    if (!file.empty()) files.emplace_back(file);
  for (const std::filesystem::path& file : files) checkTextWritable(file);
  loadInputs();
  checkOutputs(files);  // that no file which was read is overwritten
  runtime_ = std::make_unique<Runtime>();
  chooseViews();
  build();
}

Application::~Application() {
  if (device_) device_->waitIdle();  // nothing is rendered into images that the runtime destroys
}

void Application::loadInputs() {
  description_ = session::loadGraph(options_.graph, messages_);
  // Binds once without scene and headset, to report the graph's mistakes before either is asked.
  Diagnostics early = messages_;
  const graph::BoundGraph bound = graph::bind(
      description_, session::sceneEnvironment(nullptr, {}, {}, {512, 512}, options_.graph.rays), early);
  if (!hasView(bound, "left") || !hasView(bound, "right"))
    throw Error(ExitCode::Usage, "graph " + description_.name + " has no pictures for two eyes",
                "take one that has, such as foveal_stereo_view");
  insets_ = hasView(bound, "left_inset");
  outputs_.assign(kOutputs, kOutputs + (insets_ ? 4 : 2));
  progress_.stage("loading scene " + options_.scene);
  scene_ = scene::load(options_.scene, messages_, {options_.environment});
  geometry_ = scene::flatten(scene_);
}

void Application::chooseViews() {
  configuration_ =
      insets_ ? XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO : XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  const std::vector<XrViewConfigurationView> views = runtime_->views(configuration_);
  const auto sizeOf = [&](const XrViewConfigurationView& view) {
    return glm::uvec2(scaled(view.recommendedImageRectWidth, options_.resolution),
                      scaled(view.recommendedImageRectHeight, options_.resolution));
  };
  size_ = options_.size.value_or(sizeOf(views.at(0)));
  insetSize_ = insets_ ? sizeOf(views.at(2)) : size_;
}

void Application::build() {
  device_ = gpu::openDevice({.without = options_.without,
                             .validation = options_.validation ? gpu::Validation::On : gpu::Validation::Off,
                             .maker = runtime_->deviceMaker()});
  session::GraphRun::Options run;
  run.size = size_;
  run.inset = insetSize_;
  run.seed = options_.seed;
  run.rays = options_.graph.rays;
  run_ = std::make_unique<session::GraphRun>(*device_, description_, scene_, geometry_, std::move(run),
                                             messages_);
  progress_.stage("preparing " + description_.name);
  run_->prepare();
  progress_.clear();
  session::printWarnings(messages_);
  timings_ = std::make_unique<session::Timings>(run_->plan());
  session_ = std::make_unique<Session>(*runtime_, *device_, configuration_);
  tracking_ =
      std::make_unique<Tracking>(*runtime_, *session_, configuration_, options_.rig.floor.has_value());
  for (const std::string& output : outputs_) {
    const bool inset = output.ends_with("inset");
    swapchains_.emplace_back(session_->handle(), inset ? insetSize_ : size_);
    copies_.push_back({.output = output});
  }
  rig_.emplace(scene::cameraAt(scene_, 0), options_.rig);
  std::printf("%s on %s, %ux%u an eye, in %s\n%s\n", description_.name.c_str(), scene_.name.c_str(), size_.x,
              size_.y, runtime_->name().c_str(), device_->name().c_str());
  std::fflush(stdout);
}

void Application::run() {
  while (session_->follow()) {
    if (session::interrupted() || (options_.frames > 0 && index_ >= options_.frames)) session_->askForEnd();
    if (!session_->running()) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    watchdog_.begin();
    frame();
    watchdog_.end();
  }
  takeFinished(true);
  if (session_->end() == End::Lost)
    throw Error(ExitCode::DeviceLost, "the headset or its runtime has gone away",
                "the log of the runtime may say why; start again once the headset works");
}

// Seconds of the scene since the first frame.
double Application::secondsOf(XrTime display) {
  if (!first_) first_ = display;
  return double(display - *first_) * 1e-9 * options_.speed;
}

void Application::frame() {
  const FrameTime time = session_->waitForFrame();
  const Tracked tracked = time.shown ? tracking_->at(time.display) : Tracked();
  if (tracked.head) {
    render(time, tracked);
    last_ = time.display;
  } else {
    log_.skip();
    session_->endFrame(time, {});
  }
  takeFinished(false);
}

void Application::render(const FrameTime& time, const Tracked& tracked) {
  const auto start = std::chrono::steady_clock::now();
  LoggedFrame logged;
  if (last_) {
    rig_->fly(tracked, double(time.display - *last_) * 1e-9);
    const double periods = double(time.display - *last_) / double(std::max<XrDuration>(time.period, 1));
    logged.missed = uint32_t(std::max(0l, std::lround(periods) - 1));
  }
  const scene::Moment moment = course_.next(scene_, index_, rig_->steer(tracked, secondsOf(time.display)));
  for (size_t i = 0; i < swapchains_.size(); ++i) copies_[i].image = swapchains_[i].acquire();
  run_->submit(run_->frame(moment), false, false, copies_);
  for (Swapchain& swapchain : swapchains_) swapchain.release();

  std::vector<XrCompositionLayerProjectionView> views(swapchains_.size(),
                                                      {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW});
  for (size_t i = 0; i < views.size(); ++i) {
    views[i].pose = tracking_->views()[i].pose;
    views[i].fov = tracking_->views()[i].fov;
    views[i].subImage = swapchains_[i].whole();
  }
  XrCompositionLayerProjection layer{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
  layer.space = tracking_->room();
  layer.viewCount = uint32_t(views.size());
  layer.views = views.data();
  const auto* const base = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
  session_->endFrame(time, {&base, 1});

  logged.frame = index_++;
  logged.time = moment.time;
  logged.gaze = tracked.gaze.has_value();
  if (tracked.gaze) {
    logged.gazeToDisplay = double(time.display - tracked.gazeTime) * 1e-6;
    if (const std::optional<XrTime> now = runtime_->now())
      logged.gazeToSubmit = double(*now - tracked.gazeTime) * 1e-6;
  }
  logged.submitted =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  log_.add(logged);
  if (!options_.record.empty()) recorded_.push_back(moment);
}

void Application::takeFinished(bool all) {
  const auto next = [&] { return all ? run_->executor().next() : run_->executor().poll(); };
  while (const auto result = next())
    if (!options_.timings.empty()) timings_->add(*result);
}

void Application::report() {
  std::printf("%s\n", log_.table().c_str());
  if (!timings_->empty()) std::printf("%s\n", timings_->table().c_str());
  if (!options_.log.empty()) log_.write(options_.log);
  if (!options_.record.empty()) writeText(options_.record, session::headTraceTable(recorded_));
  if (!options_.timings.empty()) {
    const session::RunInfo info = {
        .device = device_->name(),
        .graph = description_.name,
        .graphHash = session::formatHash(run_->graph().hash),
        .scene = scene_.name,
        .width = size_.x,
        .height = size_.y,
        .seed = options_.seed,
        .peakDeviceBytes = device_->peakAllocatedBytes(),
        .peakHostBytes = session::peakHostBytes(),
    };
    timings_->write(options_.timings, info);
  }
  for (const std::string& file : {options_.record, options_.log, options_.timings})
    if (!file.empty()) std::printf("wrote %s\n", file.c_str());
  const std::vector<std::string> validation = device_->validationMessages();
  if (!validation.empty())
    throw Error(ExitCode::Internal, "the validation layers object, first: " + validation.front());
}

}  // namespace fovea::vr
