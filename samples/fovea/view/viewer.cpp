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

constexpr int kSamplesAFrame = 4;                // of a second graph that has a parameter `spp`
constexpr std::string_view kSecond = "second!";  // begins the sources of the second graph
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
  build_ = build(settings_, nullptr, nullptr, false);
  bench::printWarnings(build_->messages);
  report(build_->messages.list());
  watchFiles();
  sendState();
}

Viewer::~Viewer() = default;

std::unique_ptr<Viewer::Build> Viewer::build(const Settings& settings, std::shared_ptr<LoadedScene> scene,
                                             Build* before, bool keepContents) {
  auto made = std::make_unique<Build>();
  graph::LoadOptions load;
  load.searchPaths = dataFolders("graphs");
  made->file = graph::findGraph(settings.graph.graph, load.searchPaths);
  made->description = bench::loadGraph(settings.graph, made->messages);
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
  made->merged = graph::loadMerged(settings.graph.graph, load);
  made->run->prepare(before ? before->run.get() : nullptr, keepContents);
  return made;
}

// Keeps the graph that runs if another one cannot be built.
void Viewer::rebuild(const Settings& settings, std::shared_ptr<LoadedScene> scene, bool keepContents) {
  drain();
  try {
    std::unique_ptr<Build> next = build(settings, std::move(scene), build_.get(), keepContents && !broken_);
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
    broken_ = false;
    report(build_->messages.list());
    rebuildSecond(keepContents);
  } catch (const Error& error) {
    report(error.diagnostics());
  }
  sendState();
}

// Everything but the graph is that of the first.
void Viewer::rebuildSecond(bool keepContents) {
  drain();
  wanted_.clear();
  means_.clear();
  broken_ = false;  // the next frame tells whether it was the second
  if (secondName_.empty()) {
    second_.reset();
    return;
  }
  Settings settings = settings_;
  settings.graph.graph = graphByName(build_->file, secondName_).string();
  settings.graph.set.clear();
  try {
    // Frames are added up, so that a reference need not take minutes for each.
    graph::LoadOptions load;
    load.searchPaths = dataFolders("graphs");
    const json::Value merged = graph::loadMerged(settings.graph.graph, load);
    const json::Value* parameters = merged.find("parameters");
    if (accumulate_ && parameters && parameters->find("spp"))
      settings.graph.set.push_back(fmt::format("spp={}", kSamplesAFrame));
    second_ = build(settings, build_->scene, second_.get(), keepContents);
  } catch (const Error& error) {
    second_.reset();
    secondName_.clear();
    report(error.diagnostics());
  }
}

void Viewer::report(std::vector<Diagnostic> messages) {
  messages_ = std::move(messages);
  ++messageNumber_;
}

// What a command makes of the settings; nothing if it changes none of them. Throws Error(BadInput) for names that are
// not in the lists that pages are given.
std::optional<Settings> Viewer::changed(Settings settings, const Command& command) const {
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
  if (command.second && !command.second->empty()) known(graphNames(build_->file), *command.second, "graph");
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
  const bool any = command.graph || command.scene || command.size || command.seed || command.resetAll ||
                   !command.set.empty();
  return any ? std::optional(std::move(settings)) : std::nullopt;
}

void Viewer::follow(std::vector<Command> commands) {
  Settings settings = settings_;
  bool changes = false, otherScene = false, restarts = false, otherSecond = false;
  for (const Command& command : commands) {
    try {
      if (std::optional<Settings> next = changed(settings, command)) {
        settings = std::move(*next);
        changes = true;
      }
      otherScene |= command.scene.has_value();
      otherSecond |= command.second.has_value();
      if (command.second) secondName_ = *command.second;
      if (command.accumulate) accumulate_ = *command.accumulate;
    } catch (const Error& error) {
      report(error.diagnostics());
      sendState();
    }
    motion_.apply(command);
    restarts |= command.restart || command.recording.value_or(false);
    if (command.recording) exchange_.setRecording(motion_.gazeTable(), motion_.cameraKeys());
  }
  if (changes || restarts) {
    rebuild(settings, otherScene ? nullptr : build_->scene, !restarts);
  } else if (otherSecond) {
    rebuildSecond(true);
    sendState();
  }
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
  if (broken_) return false;
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
  std::vector<graph::Observation> first, second;
  for (const std::string& source : wanted_) {
    const bool ofSecond = source.starts_with(kSecond);
    try {
      if (ofSecond && !second_) {
        Shot shot;
        shot.absent = true;
        exchange_.publish(source, std::move(shot));
        continue;
      }
      graph::Observation found = findSource(*(ofSecond ? second_ : build_)->run->plan(),
                                            ofSecond ? source.substr(kSecond.size()) : source);
      found.name = source;
      (ofSecond ? second : first).push_back(std::move(found));
      observed_.push_back(source);
    } catch (const Error& error) {
      Shot shot;
      shot.refusal = error.what();
      exchange_.publish(source, std::move(shot));
    }
  }
  build_->run->executor().observe(std::move(first));
  if (second_) second_->run->executor().observe(std::move(second));
  std::erase_if(means_, [&](const auto& mean) {
    return std::find(wanted_.begin(), wanted_.end(), mean.first) == wanted_.end();
  });
}

void Viewer::render() {
  chooseObservations();
  const scene::Moment moment = motion_.next(build_->scene->scene);
  const bool observe = !observed_.empty() && (motion_.frozen() || exchange_.hungry());
  shown_.push_back(moment);
  try {
    build_->run->submit(build_->run->frame(moment), false, observe);
    // What is added up must not miss a frame.
    if (second_) second_->run->submit(second_->run->frame(moment), false, observe || accumulate_);
  } catch (const Error& error) {
    if (error.code() == ExitCode::DeviceLost || error.code() == ExitCode::OutOfMemory) throw;
    // A pass fails while it is recorded. Nothing is rendered until the graph or a file of it changes.
    drain();
    shown_.clear();
    broken_ = true;
    report(error.diagnostics());
    sendState();
    return;
  }
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

image::Metadata Viewer::metadata(const Build& build, const Shot& shot) const {
  std::string set;
  for (const std::string& text : overridesOf(build.changes)) set += (set.empty() ? "" : " ") + text;
  return {{"version", FOVEA_VERSION},
          {"graph", build.description.name},
          {"graph_hash", bench::formatHash(build.run->graph().hash)},
          {"scene", build.scene->scene.name},
          {"scene_hash", bench::formatHash(build.scene->scene.hash)},
          {"set", set},
          {"device", device_->name()},
          {"seed", std::to_string(settings_.seed)},
          {"size", fmt::format("{}x{}", settings_.size.x, settings_.size.y)},
          {"gaze", fmt::format("{},{}", shot.gaze.x, shot.gaze.y)},
          {"fovea_radius", fmt::format("{}", float(session::parameterOr(build.run->graph(), "fovea_radius",
                                                                        bench::kFoveaRadius)))},
          {"exposure", fmt::format("{}", shot.exposure)}};
}

void Viewer::publish(const Build& build, const std::string& source, const graph::FrameResult& result,
                     graph::OutputData data, uint32_t frames) {
  const double own = session::parameterOr(build.run->graph(), "exposure", 0);  // 0 means the scene's
  Shot shot;
  shot.frame = result.frame;
  shot.exposure = own > 0 ? float(own) : build.scene->scene.exposure;
  shot.gaze = seen_.gazes[0];
  shot.foveaRadius = float(session::parameterOr(build_->run->graph(), "fovea_radius", 0));
  shot.frames = frames;
  shot.metadata = std::make_shared<const image::Metadata>(metadata(build, shot));
  shot.data = std::move(data);
  exchange_.publish(source, std::move(shot));
}

void Viewer::take(graph::FrameResult result) {
  const double seconds = result.wallMs / 1000;
  if (seconds > 0)
    framesPerSecond_ = framesPerSecond_ > 0 ? 0.8 * framesPerSecond_ + 0.2 / seconds : 1 / seconds;
  if (!shown_.empty()) {
    seen_ = shown_.front();
    shown_.erase(shown_.begin());
  }
  for (auto& [name, data] : result.outputs) publish(*build_, name, result, std::move(data), 1);
  if (second_)
    if (auto other = second_->run->executor().next()) takeSecond(std::move(*other));
  throwIfObjected();
  const auto now = Exchange::Clock::now();
  if (now - lastTick_ < kTickEvery && !motion_.frozen()) return;
  lastTick_ = now;
  times_ = describeTimes(result);
  sendTick();
}

// The second graph shows the moment that the first has just shown.
void Viewer::takeSecond(graph::FrameResult result) {
  const bool still = meanOf_ && meanOf_->time == seen_.time && meanOf_->gazes == seen_.gazes &&
                     meanOf_->camera.position == seen_.camera.position &&
                     meanOf_->camera.orientation == seen_.camera.orientation;
  if (!still || !accumulate_) means_.clear();
  meanOf_ = seen_;
  for (auto& [name, data] : result.outputs) {
    const bool added = accumulate_ && FrameMean::canAdd(data.desc);
    FrameMean& mean = means_[name];
    graph::OutputData shown = added ? mean.add(data) : std::move(data);
    publish(*second_, name, result, std::move(shown), added ? mean.frames() : 1);
  }
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
  if (motion_.recording()) exchange_.setRecording(motion_.gazeTable(), motion_.cameraKeys());
  exchange_.setTick(textOf(tick));
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
      {"second", secondName_},
      {"second_graph", second_ ? describeOutputs(second_->run->graph()) : Json::array()},
      {"accumulate", accumulate_},
      {"graphs", graphNames(build_->file)},
      {"scenes", sceneNames()},
      {"set", overridesOf(build_->changes)},
      {"fovea_radius", session::parameterOr(build_->run->graph(), "fovea_radius", 0)},
      {"bounds", {vectorJson(geometry.boundsMin), vectorJson(geometry.boundsMax)}},
      {"messages", describeMessages(messages_)}};
  exchange_.setState(textOf(state));
  exchange_.setTick(textOf({{"build", builds_}}));
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
