// The command `fovea render`: runs a graph over a scene and writes pictures, times and traces.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "fovea/scene.h"
#include "framework/base/files.h"
#include "framework/base/text_file.h"
#include "framework/gpu/loader/capture.h"
#include "framework/graph/report/report.h"
#include "framework/image/overlay.h"
#include "framework/scene/fovea.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/load.h"
#include "framework/scene/motion/motion.h"
#include "framework/scene/scene.h"
#include "framework/session/graph_run.h"
#include "framework/session/head_trace.h"
#include "framework/session/interrupt.h"
#include "framework/session/progress.h"
#include "framework/session/timings.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"
#include "samples/fovea/outputs.h"
#include "samples/fovea/trace.h"

namespace fovea::cli {
namespace {

// A frame slower than this is read back at once, in case Ctrl-C makes it the last; after a faster one, another frame
// is rendered for that.
constexpr double kSlowFrameMs = 500;

struct RenderOptions {
  GraphOptions graph;
  std::string scene, environment, size = "1024x1024", inset, gaze, gazeTrace, headTrace, lens, device,
                                  timings, trace;
  double gazeGapMs = 1000 * scene::kGazeGap, frameLimit = kFrameLimit;
  std::vector<std::string> outputs, without;
  uint32_t first = 0, frames = 1, warmup = 0, seed = 1;
  std::optional<uint32_t> capture;  // number of the frame
  bool quiet = false, validation = false, showFovea = false;
};

void stopIfInterrupted() {
  if (interrupted())
    throw Error(ExitCode::Interrupted, "interrupted before the first frame was finished",
                "nothing was written");
}

// One run of the command, stage by stage.
class Render {
 public:
  explicit Render(const RenderOptions& options);
  ExitCode run();

 private:
  void checkFiles();
  void checkOutputNames() const;
  void chooseOutputs();
  void loadInputs();
  void openDevice();
  void buildPlan();
  void buildExecutor();
  void renderFrames();
  void take(graph::FrameResult result);
  void takeFinished();
  void writeResults();
  void warnOfLightBeyondRange() const;
  void report() const;
  void readHeads();
  scene::Frame frameAt(uint64_t index) const;
  void submit(uint64_t index, bool readOutputs);
  void capture(uint64_t index, bool readOutputs);
  void showFovea();
  image::Metadata metadata(uint64_t index) const;

  const RenderOptions& options_;
  Progress progress_;
  glm::uvec2 size_;
  std::optional<glm::vec2> gaze_;
  std::optional<scene::Lens> lens_;
  std::unique_ptr<OutputFiles> outputs_;
  Diagnostics messages_;
  graph::Description description_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  std::vector<scene::Moment> moments_;  // of --head-trace, from the first row on; empty without
  std::unique_ptr<gpu::Capture> capture_;
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<session::GraphRun> run_;
  std::unique_ptr<Timings> timings_;
  RunInfo info_;
  uint64_t finished_ = 0;
  double lastWallMs_ = 2 * kSlowFrameMs;       // nothing is known of the first frame
  std::optional<graph::FrameResult> picture_;  // the last frame that was read back
  std::vector<std::string> files_;             // files written besides the pictures
};

Render::Render(const RenderOptions& options)
    : options_(options), progress_(options.quiet, options.frameLimit), size_(parseSize(options.size)) {
  if (!options.gaze.empty()) gaze_ = parseGaze(options.gaze);
  if (!options.lens.empty()) lens_ = parseLens(options.lens);
  outputs_ = std::make_unique<OutputFiles>(options.outputs);
}

// Runs before anything slow, so that nothing is rendered that cannot be written.
void Render::checkFiles() {
  const auto has = [](const std::string& file, std::string_view extension) {
    return std::filesystem::path(file).extension() == extension;
  };
  if (!options_.timings.empty() && !has(options_.timings, ".json") && !has(options_.timings, ".csv"))
    throw Error(ExitCode::Usage, "cannot tell a format from --timings `" + options_.timings + "`",
                "name it .json or .csv");
  const uint64_t end = uint64_t(options_.first) + options_.warmup + options_.frames;
  if (options_.capture && (*options_.capture < options_.first || *options_.capture >= end))
    throw Error(ExitCode::Usage, fmt::format("--capture {}: that frame is not rendered", *options_.capture),
                fmt::format("the frames of this run are {} to {}", options_.first, end - 1));
  if (options_.capture) capture_ = std::make_unique<gpu::Capture>();
  outputs_->checkWritable();
  for (const std::string& file : {options_.timings, options_.trace})
    if (!file.empty()) checkTextWritable(file);
  checkOutputNames();
}

// Runs again when more files were read.
void Render::checkOutputNames() const {
  std::vector<std::filesystem::path> others = filesRead(), texts;
  for (const std::string& file : {options_.timings, options_.trace})
    if (!file.empty()) texts.emplace_back(file);
  others.insert(others.end(), texts.begin(), texts.end());
  std::vector<std::filesystem::path> files = outputs_->paths(std::move(others));
  files.insert(files.end(), texts.begin(), texts.end());
  checkOutputs(files);
}

// A run without any other output writes a picture.
void Render::chooseOutputs() {
  if (!outputs_->empty() || !options_.timings.empty() || !options_.trace.empty()) return;
  outputs_ =
      std::make_unique<OutputFiles>(std::vector<std::string>{description_.name + "-" + scene_.name + ".png"});
  outputs_->checkWritable();
}

void Render::loadInputs() {
  description_ = loadGraph(options_.graph, messages_);
  // Binds once without the scene, to report the graph's mistakes before the scene is loaded.
  Diagnostics early = messages_;
  const graph::BoundGraph bound = graph::bind(
      description_, session::sceneEnvironment(nullptr, {}, {}, size_, options_.graph.rays), early);
  std::vector<scene::GazeSample> trace;
  if (!options_.gazeTrace.empty()) trace = scene::readGazeCsv(options_.gazeTrace);
  progress_.stage("loading scene " + options_.scene);
  scene_ = scene::load(options_.scene, messages_, {options_.environment});
  if (lens_) {
    if (bound.views.size() < 2)
      throw Error(ExitCode::Usage,
                  "graph " + description_.name + " has no eyes that could look through --lens",
                  "take one for both eyes, as `stereo`");
    scene_.lens = lens_;
    scene_.hash = scene::contentHash(scene_);
  }
  geometry_ = scene::flatten(scene_);
  if (!options_.gazeTrace.empty()) scene_.gaze = std::move(trace);
  if (gaze_) scene_.gaze = {{0, *gaze_, true, {}, {}}};
  scene_.gazeGap = 0.001 * options_.gazeGapMs;
  if (!options_.headTrace.empty()) readHeads();
  chooseOutputs();
  checkOutputNames();
  stopIfInterrupted();
}

void Render::readHeads() {
  moments_ = session::replay(scene_, session::readHeadTrace(options_.headTrace, scene::cameraAt(scene_, 0)));
  const uint64_t end = uint64_t(options_.first) + options_.warmup + options_.frames;
  if (moments_.size() < end)
    throw Error(ExitCode::Usage,
                fmt::format("{} has {} frames, and the last one of this run is number {}", options_.headTrace,
                            moments_.size(), end - 1),
                "choose --first, --warmup and --frames so that they fit");
}

scene::Frame Render::frameAt(uint64_t index) const {
  return moments_.empty() ? run_->frame(index) : run_->frame(moments_[index]);
}

void Render::openDevice() {
  try {
    device_ =
        gpu::openDevice({.device = options_.device,
                         .without = options_.without,
                         .validation = options_.validation ? gpu::Validation::On : gpu::Validation::Off});
  } catch (const Error& e) {
    if (!capture_ || e.code() != ExitCode::NoDevice) throw;
    std::vector<Diagnostic> messages = e.diagnostics();
    messages.back().remedy =
        "RenderDoc lets only those devices be used that have bufferDeviceAddressCaptureReplay, as GPUs do: "
        "choose one, or leave out --capture";
    throw Error(e.code(), std::move(messages));
  }
}

void Render::buildPlan() {
  openDevice();
  session::GraphRun::Options run;
  run.size = size_;
  if (!options_.inset.empty()) run.inset = parseSize(options_.inset);
  run.seed = options_.seed;
  run.rays = options_.graph.rays;
  run.readback = [this](const graph::BoundGraph& graph) { return outputs_->outputsOf(graph, size_); };
  run.hostProgress = [this](const std::string& pass, double share) {
    progress_.pass(pass, share);
    return !interrupted();
  };
  run_ = std::make_unique<session::GraphRun>(*device_, description_, scene_, geometry_, std::move(run),
                                             messages_);
  progress_.clear();
  printWarnings(messages_);
}

void Render::buildExecutor() {
  progress_.stage("preparing " + description_.name);
  run_->prepare();
  checkOutputNames();
  timings_ = std::make_unique<Timings>(run_->plan());
  showFovea();
  info_ = {device_->name(),
           description_.name,
           formatHash(run_->graph().hash),
           scene_.name,
           size_.x,
           size_.y,
           options_.warmup,
           options_.seed,
           0,
           0};
  stopIfInterrupted();
}

// Gaze of the eye that the picture `image` shows.
void Render::showFovea() {
  if (!options_.showFovea) return;
  const graph::BoundGraph& graph = run_->graph();
  std::string eye = graph.views[0];
  for (const graph::BoundOutput& output : graph.outputs)
    for (const graph::BoundPass& pass : graph.passes)
      for (const graph::Access& access : pass.accesses)
        if (output.name == "image" && access.writes && access.resource == output.resource)
          eye = graph.views[pass.view];
  outputs_->setOverlay([this, eye](image::Image& picture, uint64_t index) {
    const scene::Frame shown = frameAt(index);
    const scene::View& view = *shown.findView(eye);
    const scene::Fovea fovea = scene::makeFovea(view.gaze, {picture.width, picture.height}, view.foveaRadius);
    image::drawFovea(picture, {fovea.centre.x, fovea.centre.y, fovea.radius});
  });
}

void Render::submit(uint64_t index, bool readOutputs) { run_->submit(frameAt(index), readOutputs); }

// The capture holds nothing but this frame: those before it have ended, and the next one begins when it has.
void Render::capture(uint64_t index, bool readOutputs) {
  while (auto result = run_->executor().next()) take(std::move(*result));
  capture_->begin();
  submit(index, readOutputs);
  while (auto result = run_->executor().next()) take(std::move(*result));
  files_.push_back(fmt::format("{}-{}-{}.rdc", description_.name, scene_.name, index));
  capture_->end(files_.back());
}

image::Metadata Render::metadata(uint64_t index) const {
  const scene::Frame shown = frameAt(index);
  std::string set;
  for (const std::string& text : options_.graph.set) set += (set.empty() ? "" : " ") + text;
  image::Metadata data = {{"version", FOVEA_VERSION},
                          {"graph", info_.graph},
                          {"graph_hash", info_.graphHash},
                          {"scene", info_.scene},
                          {"scene_hash", formatHash(scene_.hash)},
                          {"device", info_.device},
                          {"seed", std::to_string(info_.seed)},
                          {"size", fmt::format("{}x{}", size_.x, size_.y)}};
  data["gaze"] = fmt::format("{},{}", shown.views[0].gaze.x, shown.views[0].gaze.y);
  data["fovea_radius"] = fmt::format("{}", shown.views[0].foveaRadius);
  const float exposure =
      float(session::parameterOr(run_->graph(), "exposure", 0));  // of tonemap; 0 means the scene's
  data["exposure"] = fmt::format("{}", exposure > 0 ? exposure : shown.exposure);
  if (!set.empty()) data["set"] = set;
  return data;
}

void Render::take(graph::FrameResult result) {
  const bool warm = finished_++ < options_.warmup;
  lastWallMs_ = result.wallMs;
  progress_.frames(finished_, uint64_t(options_.warmup) + options_.frames);
  if (warm) return;
  timings_->add(result);
  if (result.outputs.empty()) return;
  outputs_->writeFrame(result, metadata(result.frame));
  picture_ = std::move(result);
}

void Render::takeFinished() {
  if (run_->inFlight() == 1) {
    while (auto result = run_->executor().next()) take(std::move(*result));
  } else {
    while (auto result = run_->executor().poll()) take(std::move(*result));
  }
}

void Render::renderFrames() {
  const uint64_t total = uint64_t(options_.warmup) + options_.frames;
  const bool pictures = !run_->readback().empty();
  progress_.frames(0, total);
  uint64_t index = 0;  // since the first frame of the run
  for (; index < total && !interrupted(); ++index) {
    const bool keep = outputs_->hasSequence() || index + 1 == total || lastWallMs_ > kSlowFrameMs;
    const uint64_t frame = options_.first + index;
    const bool read = pictures && keep && index >= options_.warmup;
    if (frame == options_.capture)
      capture(frame, read);
    else
      submit(frame, read);
    takeFinished();
  }
  while (auto result = run_->executor().next()) take(std::move(*result));
  if (interrupted() && pictures && !picture_ && index >= options_.warmup) {
    submit(options_.first + index, true);
    while (auto result = run_->executor().next()) take(std::move(*result));
  }
  progress_.clear();
}

void Render::writeResults() {
  if (timings_->empty()) stopIfInterrupted();
  if (picture_) outputs_->writeLast(*picture_, metadata(picture_->frame));
  picture_.reset();
  info_.peakDeviceBytes = device_->peakAllocatedBytes();
  info_.peakHostBytes = session::peakHostBytes();
  if (!options_.timings.empty()) {
    timings_->write(options_.timings, info_);
    files_.push_back(options_.timings);
  }
  if (!options_.trace.empty()) {
    writeText(options_.trace, chromeTrace(*timings_, info_));
    files_.push_back(options_.trace);
  }
}

void Render::warnOfLightBeyondRange() const {
  Diagnostics warnings;
  for (const auto& [output, pixels] : outputs_->beyondRange())
    warnings.warning(
        {}, output,
        fmt::format(
            "the light of {} pixels is too bright to be stored or no number; with the scene's exposure "
            "{:.3g}, half floats end at a radiance of {:.3g}",
            pixels, scene_.exposure, 65504 / scene::preExposure(scene_)),
        "give the scene file an exposure that suits its light");
  printWarnings(warnings);
}

void Render::report() const {
  if (options_.quiet) return;
  std::printf("%s on %s, %ux%u, seed %u\n%s\n\n%s\n", info_.graph.c_str(), info_.scene.c_str(), size_.x,
              size_.y, info_.seed, info_.device.c_str(), timings_->table().c_str());
  std::printf(
      "peak memory: %s on the device, %s on the host%s\n", graph::printBytes(info_.peakDeviceBytes).c_str(),
      graph::printBytes(info_.peakHostBytes).c_str(), device_->isCpu() ? " (device memory included)" : "");
  std::vector<std::string> files = outputs_->written();
  files.insert(files.end(), files_.begin(), files_.end());
  for (const std::string& file : files) std::printf("wrote %s\n", file.c_str());
}

ExitCode Render::run() {
  checkFiles();
  loadInputs();
  catchInterrupts();
  buildPlan();
  buildExecutor();
  renderFrames();
  writeResults();
  warnOfLightBeyondRange();
  report();
  if (!outputs_->withoutNumbers().empty())
    throw Error(
        ExitCode::Internal,
        fmt::format("no pixel of the output `{}` is a number (NaN)", *outputs_->withoutNumbers().begin()),
        "a pass divides by zero or reads what nothing wrote: `fovea view` shows what each pass makes");
  const std::vector<std::string> validation = device_->validationMessages();
  if (!validation.empty())
    throw Error(ExitCode::Internal, fmt::format("the validation layers object {} times, first: {}",
                                                validation.size(), validation.front()));
  return interrupted() ? ExitCode::Interrupted : ExitCode::Ok;
}

void addOutputOptions(CLI::App& command, RenderOptions& options) {
  addList(command, "-o,--output", options.outputs,
          "Picture, may be repeated: .png shows the graph's output `image`,\n"
          ".exr holds every floating-point output as a layer; OUTPUT=FILE shows another\n"
          "output (image_right=right.png); a name like out_%04d.exr writes every frame.\n"
          "Default: GRAPH-SCENE.png, none with --timings or --trace")
      ->type_name("[OUTPUT=]FILE");
  command
      .add_option(
          "--timings", options.timings,
          "Times and counters: .json (median, min, p95, and every frame) or .csv (every\nframe and pass)")
      ->type_name("FILE");
  command.add_option("--trace", options.trace, "Trace of passes and frames for ui.perfetto.dev")
      ->type_name("FILE.json");
  command
      .add_option("--capture", options.capture,
                  "Frame of which RenderDoc makes a capture, GRAPH-SCENE-N.rdc; numbered as with --first")
      ->type_name("N")
      ->transform(wholeNumberBetween(0, UINT32_MAX));
  command.add_flag("-q,--quiet", options.quiet, "Print nothing but warnings and errors");
}

}  // namespace

void addRender(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("render", "Render a scene with a graph");
  auto options = std::make_shared<RenderOptions>();
  addGraphOptions(*command, options->graph);
  command
      ->add_option("--scene", options->scene,
                   "Scene: a .json, .gltf or .glb file, or a bare name (cornellbox)")
      ->required()
      ->type_name("SCENE");
  addFollowLinksOption(*command);
  addEnvironmentOption(*command, options->environment);
  addOutputOptions(*command, *options);
  command->add_option("--size", options->size, "Picture size, 1 to 16384 pixels a side; default 1024x1024")
      ->type_name("WxH");
  command
      ->add_option("--inset", options->inset,
                   "Size of the insets of graphs that have any (foveal_quad); default: that of --size")
      ->type_name("WxH");
  command->add_option("--frames", options->frames, "Frames to render and measure; default 1")
      ->type_name("N")
      ->transform(wholeNumberBetween(1, 10'000'000));
  command
      ->add_option("--warmup", options->warmup,
                   "Frames before those, neither measured nor written; default 0")
      ->type_name("N")
      ->transform(wholeNumberBetween(0, 10'000'000));
  command
      ->add_option(
          "--first", options->first,
          "Number of the first frame, warm-up included: the scene's time is 42 frames a\nsecond; default 0")
      ->type_name("N")
      ->transform(wholeNumberBetween(0, 10'000'000));
  command->add_option("--seed", options->seed, "Seed of all random numbers; default 1")
      ->type_name("S")
      ->transform(wholeNumberBetween(0, UINT32_MAX));
  command
      ->add_option("--gaze", options->gaze,
                   "Where the eye looks, 0,0 (top left) to 1,1; default: the scene's")
      ->type_name("X,Y");
  CLI::Option* trace =
      command
          ->add_option("--gaze-trace", options->gazeTrace,
                       "Where the eye looks over time: a table t,x,y,valid (seconds, 0 to 1 from\nthe "
                       "top left, 0 in a blink) instead of the scene's")
          ->type_name("FILE.csv")
          ->excludes("--gaze");
  command
      ->add_option(
          "--head-trace", options->headTrace,
          "Head, eyes, gaze and time of every frame, a row each, as `fovea vr --record`\nwrites them")
      ->type_name("FILE.csv")
      ->excludes("--gaze")
      ->excludes("--gaze-trace");
  command
      ->add_option(
          "--gaze-gap", options->gazeGapMs,
          "Join samples of the trace that lie at most so many ms apart; others, and jumps\nof more than "
          "5% of the picture, hold the last one; default 50")
      ->type_name("MS")
      ->needs(trace)
      ->check(numberBetween(0, 10000));
  command
      ->add_option(
          "--lens", options->lens,
          "What each eye of stereo graphs sees: degrees from the line of sight outwards,\ninwards, up "
          "and down (55,45,50,52); default: the scene's, else its camera's")
      ->type_name("O,I,U,D");
  command->add_flag("--show-fovea", options->showFovea,
                    "Draw the foveal circle and a cross where the eye looks onto .png pictures");
  addDeviceOptions(*command, options->device, options->without);
  addFrameLimitOption(*command, options->frameLimit);
  command->add_flag("--validation", options->validation, "Run under the Vulkan validation layers (slow)");
  command->callback([options, &action] { action = [options] { return Render(*options).run(); }; });
}

}  // namespace fovea::cli
