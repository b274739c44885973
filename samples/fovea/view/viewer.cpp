#include "samples/fovea/view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmarks/runner/interrupt.h"
#include "framework/base/paths.h"
#include "framework/base/text_file.h"
#include "framework/gpu/shader/shader.h"
#include "framework/graph/pass/registry.h"
#include "framework/scene/scene.h"
#include "samples/fovea/view/graph/catalog.h"
#include "samples/fovea/view/graph/describe.h"
#include "samples/fovea/view/graph/sources.h"

namespace fovea::view {
namespace {

using Json = nlohmann::json;
using std::chrono::milliseconds;

constexpr auto kTickEvery = milliseconds(50);
constexpr auto kIdle = milliseconds(100), kRest = milliseconds(60);

Json vectorJson(glm::vec3 v) { return {v.x, v.y, v.z}; }

}  // namespace

Viewer::Viewer(Exchange& exchange, const Options& options)
    : exchange_(exchange), options_(options), settings_(options.settings) {
  // Mistakes in the graph are told before a device is looked for and a scene loaded.
  Diagnostics early;
  const graph::Description description = bench::loadGraph(settings_.graph, early);
  graph::bind(description, session::sceneEnvironment(nullptr, {}, {}, settings_.size), early);
  device_ = session::openDevice(options.device, options.validation);
  build_ = build(settings_, nullptr, false);
  bench::printWarnings(build_->messages);
  report(build_->messages.list());
  watchFiles();
  sendState();
}

Viewer::~Viewer() = default;

std::unique_ptr<Viewer::Build> Viewer::build(const Settings& settings, std::shared_ptr<LoadedScene> scene,
                                             bool keepContents) {
  auto made = std::make_unique<Build>();
  graph::LoadOptions load;
  load.searchPaths = dataFolders("graphs");
  made->file = graph::findGraph(settings.graph.graph, load.searchPaths);
  made->description = bench::loadGraph(settings.graph, made->messages);
  made->merged = graph::loadMerged(settings.graph.graph, load);
  made->changes = changesOf(settings.graph.set);
  if (!scene) {
    scene = std::make_shared<LoadedScene>();
    scene->scene = scene::load(settings.scene, made->messages);
    scene->geometry = scene::flatten(scene->scene);
  }
  made->scene = std::move(scene);
  session::GraphRun::Options run;
  run.size = settings.size;
  run.seed = settings.seed;
  run.observable = true;
  run.hostProgress = [](const std::string&, double) { return !bench::interrupted(); };
  made->run = std::make_unique<session::GraphRun>(*device_, made->description, made->scene->scene,
                                                  made->scene->geometry, std::move(run), made->messages);
  made->run->prepare(build_ ? build_->run.get() : nullptr, keepContents);
  return made;
}

// Keeps the graph that runs if another one cannot be built.
void Viewer::rebuild(const Settings& settings, std::shared_ptr<LoadedScene> scene, bool keepContents) {
  drain();
  try {
    std::unique_ptr<Build> next = build(settings, std::move(scene), keepContents);
    const bool otherScene = next->scene != build_->scene;
    build_ = std::move(next);
    settings_ = settings;
    if (otherScene) motion_.restart();
    watchFiles();
    wanted_.clear();
    observed_.clear();
    exchange_.clearShots();
    shown_.clear();
    times_ = nullptr;
    report(build_->messages.list());
  } catch (const Error& error) {
    report(error.diagnostics());
  }
  sendState();
}

void Viewer::report(std::vector<Diagnostic> messages) {
  messages_ = std::move(messages);
  ++messageNumber_;
}

bool Viewer::change(Settings& settings, const Command& command) const {
  const auto known = [](const std::vector<std::string>& names, const std::string& name, const char* what) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(ExitCode::BadInput, fmt::format("there is no {} `{}`", what, name),
                  "choose one of the list");
  };
  if (command.graph) {
    known(graphNames(build_->file), *command.graph, "graph");
    settings.graph.graph = graphByName(build_->file, *command.graph).string();
    settings.graph.set.clear();
  }
  if (command.scene) {
    known(sceneNames(), *command.scene, "scene");
    settings.scene = *command.scene;
  }
  if (command.size) settings.size = *command.size;
  if (command.seed) settings.seed = *command.seed;
  Changes changes = changesOf(settings.graph.set);
  if (command.resetAll) changes.clear();
  for (const auto& [name, value] : command.set) {
    if (value)
      changes[name] = *value;
    else
      changes.erase(name);
  }
  settings.graph.set = overridesOf(changes);
  return command.graph || command.scene || command.size || command.seed || command.resetAll ||
         !command.set.empty();
}

void Viewer::follow(std::vector<Command> commands) {
  Settings settings = settings_;
  bool changed = false, otherScene = false, restarts = false;
  for (const Command& command : commands) {
    try {
      changed |= change(settings, command);
      otherScene |= command.scene.has_value();
    } catch (const Error& error) {
      report(error.diagnostics());
      sendState();
    }
    motion_.apply(command);
    restarts |= command.restart || command.recording.value_or(false);
    if (command.recording) exchange_.setGazeTable(motion_.gazeTable());
  }
  if (changed || restarts) rebuild(settings, otherScene ? nullptr : build_->scene, !restarts);
  for (const Command& command : commands)
    if (command.save) save(*command.save);
  if (!commands.empty()) sendTick();
}

// Beside the graph, and never over another file.
void Viewer::save(const std::string& name) {
  try {
    const std::filesystem::path file = build_->file.parent_path() / (name + ".json");
    if (std::filesystem::exists(file))
      throw Error(ExitCode::CannotWrite, fmt::format("{} exists already", file.string()),
                  "take another name");
    writeText(file, extendingGraph(build_->file.filename().string(), build_->changes, build_->merged,
                                   build_->run->graph()));
    report({{Severity::Note, {file.string(), 0, 0}, {}, fmt::format("wrote {}", file.string()), {}}});
  } catch (const Error& error) {
    report(error.diagnostics());
  }
  sendState();
}

bool Viewer::frameIsDue() {
  if (options_.frames > 0 && submitted_ >= options_.frames) {
    motion_.freeze();
    options_.frames = 0;
  }
  if (options_.frames > 0) return true;
  if (motion_.due()) return true;
  return exchange_.watched() && (!motion_.frozen() || exchange_.lacking());
}

// A scene's second lasts no less than a second, as far as the clock of the machine goes.
void Viewer::pace() {
  const auto now = Exchange::Clock::now();
  if (now < nextFrame_) exchange_.waitForWork(std::chrono::duration_cast<milliseconds>(nextFrame_ - now));
  nextFrame_ = std::max(now, nextFrame_) + std::chrono::microseconds(int64_t(1e6 / kFrameRate));
}

void Viewer::chooseObservations() {
  std::vector<std::string> wanted = exchange_.wanted();
  if (wanted == wanted_) return;
  drain();
  wanted_ = std::move(wanted);
  observed_.clear();
  std::vector<graph::Observation> observations;
  for (const std::string& source : wanted_) {
    try {
      observations.push_back(findSource(*build_->run->plan(), source));
      observed_.push_back(source);
    } catch (const Error& error) {
      Shot shot;
      shot.refusal = error.what();
      exchange_.publish(source, std::move(shot));
    }
  }
  build_->run->executor().observe(std::move(observations));
}

void Viewer::render() {
  chooseObservations();
  const scene::Moment moment = motion_.next(build_->scene->scene);
  const bool observe = !observed_.empty() && (motion_.frozen() || exchange_.hungry());
  shown_.push_back(moment);
  build_->run->submit(build_->run->frame(moment), false, observe);
  ++submitted_;
  takeFinished();
  if (motion_.frozen() || build_->run->inFlight() == 1) drain();
}

void Viewer::takeFinished() {
  while (auto result = build_->run->executor().poll()) take(std::move(*result));
}

void Viewer::drain() {
  while (auto result = build_->run->executor().next()) take(std::move(*result));
}

void Viewer::take(graph::FrameResult result) {
  const double seconds = result.wallMs / 1000;
  if (seconds > 0)
    framesPerSecond_ = framesPerSecond_ > 0 ? 0.8 * framesPerSecond_ + 0.2 / seconds : 1 / seconds;
  for (auto& [name, data] : result.outputs) {
    Shot shot;
    shot.frame = result.frame;
    shot.exposure = build_->scene->scene.exposure;
    shot.data = std::move(data);
    exchange_.publish(name, std::move(shot));
  }
  if (!shown_.empty()) {
    seen_ = shown_.front();
    shown_.erase(shown_.begin());
  }
  throwIfObjected();
  const auto now = Exchange::Clock::now();
  if (now - lastTick_ < kTickEvery && !motion_.frozen()) return;
  lastTick_ = now;
  times_ = describeTimes(result);
  sendTick();
}

void Viewer::throwIfObjected() const {
  if (!options_.validation) return;
  const std::vector<std::string> objections = device_->validationMessages();
  if (!objections.empty())
    throw Error(ExitCode::Internal, fmt::format("the validation layers object {} times, first: {}",
                                                objections.size(), objections.front()));
}

void Viewer::sendTick() {
  if (times_.is_null()) return;
  const Pose pose = poseOf(seen_.camera);
  Json tick{{"build", builds_},
            {"messages", messageNumber_},
            {"frame", seen_.index},
            {"time", seen_.time},
            {"playing", motion_.playing()},
            {"frozen", motion_.frozen()},
            {"speed", motion_.speed()},
            {"recording", motion_.recording()},
            {"recorded", motion_.recorded()},
            {"camera",
             {{"position", vectorJson(pose.position)},
              {"yaw", pose.yaw},
              {"pitch", pose.pitch},
              {"own", motion_.ownCamera()},
              {"fov", seen_.camera.verticalFov}}},
            {"gaze", {seen_.gazes[0].x, seen_.gazes[0].y}},
            {"own_gaze", motion_.ownGaze()},
            {"saccade", seen_.saccade},
            {"fps", framesPerSecond_},
            {"bytes", device_->allocatedBytes()},
            {"times", times_}};
  if (motion_.recording()) exchange_.setGazeTable(motion_.gazeTable());
  exchange_.setTick(tick.dump());
}

void Viewer::sendState() {
  ++builds_;
  const scene::Geometry& geometry = build_->scene->geometry;
  Json state{
      {"build", builds_},
      {"device", device_->name()},
      {"version", FOVEA_VERSION},
      {"graph", describeGraph(*build_->run->plan(), build_->description, build_->merged, build_->changes)},
      {"graph_name", build_->file.stem().string()},
      {"graph_file", build_->file.string()},
      {"scene", settings_.scene},
      {"size", {settings_.size.x, settings_.size.y}},
      {"seed", settings_.seed},
      {"graphs", graphNames(build_->file)},
      {"scenes", sceneNames()},
      {"set", overridesOf(build_->changes)},
      {"fovea_radius", session::parameterOr(build_->run->graph(), "fovea_radius", 0)},
      {"bounds", {vectorJson(geometry.boundsMin), vectorJson(geometry.boundsMax)}},
      {"messages", describeMessages(messages_)}};
  exchange_.setState(state.dump());
  exchange_.setTick(Json{{"build", builds_}}.dump());
}

// Everything from which the run was made.
void Viewer::watchFiles() {
  std::set<std::filesystem::path> folders;
  const auto add = [&](const std::filesystem::path& folder) { folders.merge(withSubfolders(folder)); };
  const std::filesystem::path beside = build_->file.parent_path();
  folders.insert(beside.empty() ? "." : beside);
  add(beside / "passes");
  for (const char* kind : {"graphs", "shaders", "passes"})
    for (const std::filesystem::path& folder : dataFolders(kind)) add(folder);
  for (const std::string& folder : settings_.graph.passes) add(folder);
  for (const std::filesystem::path& folder : pathsInVariable("FOVEA_PASSES")) add(folder);
  const std::filesystem::path scene = build_->scene->scene.source;
  std::error_code ec;
  if (std::filesystem::is_regular_file(scene, ec))
    folders.insert(scene.has_parent_path() ? scene.parent_path() : std::filesystem::path("."));
  watcher_.watch(folders);
}

// An editor writes several files in a row, or one in several steps; a moment of rest ends that.
void Viewer::reloadChanged() {
  const auto now = Exchange::Clock::now();
  std::set<std::filesystem::path> changed = watcher_.changed();
  if (!changed.empty()) {
    changedFiles_.merge(changed);
    changedAt_ = now;
  }
  if (changedFiles_.empty() || now - changedAt_ < kRest) return;
  const std::set<std::filesystem::path> files = std::exchange(changedFiles_, {});
  std::error_code ec;
  const std::filesystem::path source = build_->scene->scene.source;
  const bool scene = std::any_of(files.begin(), files.end(), [&](const std::filesystem::path& file) {
    const bool model = file.extension() != ".json";
    return std::filesystem::equivalent(file, source, ec) ||
           (model && file.parent_path() == source.parent_path() && source.has_parent_path());
  });
  device_->shaders().forget();
  try {
    graph::Registry::global().rereadFiles();
    rebuild(settings_, scene ? nullptr : build_->scene);
  } catch (const Error& error) {
    report(error.diagnostics());
    sendState();
  }
}

void Viewer::run() {
  while (!bench::interrupted()) {
    follow(exchange_.takeCommands());
    reloadChanged();
    if (!frameIsDue()) {
      drain();
      exchange_.waitForWork(kIdle);
      continue;
    }
    if (options_.frames == 0) pace();
    render();
  }
  drain();
}

}  // namespace fovea::view
