#include "samples/fovea/view/viewer.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/base/paths.h"
#include "framework/base/text_file.h"
#include "framework/gpu/shader/shader.h"
#include "framework/graph/pass/registry.h"
#include "framework/scene/scene.h"
#include "framework/session/interrupt.h"
#include "samples/fovea/view/graph/catalog.h"

namespace fovea::view {
namespace {

using std::chrono::milliseconds;

constexpr int kSamplesAFrame = 4;  // of a second graph that has a parameter `spp`
// The radiance where a graph has it, which is what tev is for.
std::string mainOutput(const graph::BoundGraph& graph) {
  const auto found = std::find_if(graph.outputs.begin(), graph.outputs.end(),
                                  [](const graph::BoundOutput& o) { return o.name == "radiance"; });
  return found != graph.outputs.end() ? found->name : graph.outputs.front().name;
}

constexpr auto kIdle = milliseconds(100), kRest = milliseconds(60);

}  // namespace

Viewer::Viewer(Exchange& exchange, const Options& options)
    : exchange_(exchange),
      options_(options),
      settings_(options.settings),
      watchdog_(std::chrono::duration<double>(options.frameLimit), ExitCode::DeviceLost,
                session::frameLimitMessage(options.frameLimit)) {
  // Mistakes in the graph are told before a device is looked for and a scene loaded.
  Diagnostics early;
  const graph::Description description = session::loadGraph(settings_.graph, early);
  graph::bind(description, session::sceneEnvironment(nullptr, {}, {}, settings_.size, settings_.graph.rays),
              early);
  if (!options.tev.empty()) tev_ = std::make_unique<TevStream>(exchange, options.tev);
  device_ = gpu::openDevice({.device = options.device,
                             .without = options.without,
                             .validation = options.validation ? gpu::Validation::On : gpu::Validation::Off});
  build_ = build(settings_, nullptr, nullptr, false);
  session::printWarnings(build_->messages);
  report(build_->messages.list());
  watchFiles();
  if (options.resume) {
    motion_.apply(parseCommand(options.resume->motion));
    secondName_ = options.resume->second;
    accumulate_ = options.resume->accumulate;
    rebuildSecond(false);
  }
  if (tev_) tev_->show(options.resume ? options.resume->tev : mainOutput(build_->run->graph()));
  sendState();
}

Viewer::~Viewer() = default;

std::unique_ptr<Viewer::Build> Viewer::build(const Settings& settings, std::shared_ptr<LoadedScene> scene,
                                             Build* before, bool keepContents) {
  auto made = std::make_unique<Build>();
  graph::LoadOptions load;
  load.searchPaths = dataFolders("graphs");
  made->file = graph::findGraph(settings.graph.graph, load.searchPaths);
  made->description = session::loadGraph(settings.graph, made->messages);
  made->changes = changesOf(settings.graph.set);
  if (!scene) {
    scene = std::make_shared<LoadedScene>();
    scene->scene = scene::load(settings.scene, made->messages, {settings.environment});
    scene->geometry = scene::flatten(scene->scene);
  }
  made->scene = std::move(scene);
  session::GraphRun::Options run;
  run.size = settings.size;
  run.seed = settings.seed;
  run.rays = settings.graph.rays;
  run.observable = true;
  run.hostProgress = [](const std::string&, double) { return !session::interrupted(); };
  made->run = std::make_unique<session::GraphRun>(*device_, made->description, made->scene->scene,
                                                  made->scene->geometry, std::move(run), made->messages);
  made->documents = loadDocuments(made->file, load);
  made->run->prepare(before ? before->run.get() : nullptr, keepContents);
  return made;
}

void Viewer::rebuild(const Settings& settings, std::shared_ptr<LoadedScene> scene, bool keepContents) {
  drain();
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

// Stays when a file changes, unlike what is said about the graph.
void Viewer::answer(std::vector<Diagnostic> messages) {
  answer_ = std::move(messages);
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
    known(scene::names(), *command.scene, "scene");
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

void Viewer::follow(const std::vector<Command>& commands) {
  Settings settings = settings_;
  bool changes = false, otherScene = false, restarts = false, otherSecond = false;
  std::vector<Diagnostic> answers;
  for (const Command& command : commands) {
    try {
      if (std::optional<Settings> next = changed(settings, command)) {
        settings = std::move(*next);
        changes = true;
      }
      otherScene |= command.scene.has_value();
      otherSecond |= command.second.has_value();
      if (command.second) secondName_ = *command.second;
      if (command.tev && tev_) tev_->show(*command.tev);
      if (command.accumulate) accumulate_ = *command.accumulate;
    } catch (const Error& error) {
      answers = error.diagnostics();
    }
    motion_.apply(command);
    restarts |= command.restart || command.recording.value_or(false);
    if (command.recording)
      exchange_.setRecording(motion_.gazeTable(), motion_.cameraKeys(build_->scene->scene.origin));
  }
  try {
    if (changes || restarts)
      rebuild(settings, otherScene ? nullptr : build_->scene, !restarts);
    else if (otherSecond)
      rebuildSecond(true);
    for (const Command& command : commands)
      if (command.save) answers = {save(*command.save)};
  } catch (const Error& error) {
    answers = error.diagnostics();
  }
  const bool saves = std::any_of(commands.begin(), commands.end(), [](const Command& c) { return c.save; });
  if (changes || restarts || otherSecond || saves || !answers.empty()) {
    answer(std::move(answers));
    sendState();
  }
  if (!commands.empty()) sendTick();
}

Diagnostic Viewer::save(const std::string& name) const {
  const std::filesystem::path file = build_->file.parent_path() / (name + ".json");
  if (std::filesystem::exists(file))
    throw Error(ExitCode::CannotWrite, fmt::format("{} exists already", file.string()), "take another name");
  writeText(file, extendingGraph(build_->file.filename().string(), build_->changes, build_->documents,
                                 build_->run->graph()));
  return {Severity::Note, {file.string(), 0, 0}, {}, fmt::format("wrote {}", file.string()), {}};
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
  for (const std::string& plugin : settings_.graph.plugins) {
    const std::filesystem::path folder = std::filesystem::path(plugin).parent_path();
    folders.insert(folder.empty() ? "." : folder);
  }
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
  for (const std::filesystem::path& file : files)
    for (const std::string& plugin : settings_.graph.plugins)
      if (std::filesystem::equivalent(file, plugin, ec)) return restartFor(file);
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
  }
  sendState();
}

// Nothing of a plug-in that cannot be used gets as far as this process.
void Viewer::restartFor(const std::filesystem::path& plugin) {
  drain();
  const std::string reason = whyNotLoadable(settings_.graph);
  restart_ = reason.empty();
  if (restart_) return;
  report({{Severity::Error, {plugin.string(), 0, 0}, {}, reason, "what was loaded before goes on"}});
  sendState();
}

Resume Viewer::resume() const {
  Resume resume;
  resume.graph = settings_.graph.graph;
  resume.set = settings_.graph.set;
  resume.scene = settings_.scene;
  resume.second = secondName_;
  resume.accumulate = accumulate_;
  resume.tev = tev_ ? tev_->source() : "";
  resume.width = settings_.size.x;
  resume.height = settings_.size.y;
  resume.seed = settings_.seed;
  resume.motion = motion_.asCommand();
  return resume;
}

bool Viewer::run() {
  while (!session::interrupted() && !restart_) {
    follow(exchange_.takeCommands());
    reloadChanged();
    if (!frameIsDue()) {
      drain();
      exchange_.waitForWork(kIdle);
      continue;
    }
    if (options_.frames == 0) pace();
    watchdog_.begin();
    render();
    watchdog_.end();
  }
  drain();
  return restart_ && !session::interrupted();
}

}  // namespace fovea::view
