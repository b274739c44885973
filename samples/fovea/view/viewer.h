// The run behind `fovea view`: renders a graph over a scene for as long as a page is open, follows the requests of
// pages, and keeps the last valid graph running when something is wrong.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "framework/base/watchdog.h"
#include "framework/session/graph_run.h"
#include "framework/session/inputs.h"
#include "framework/session/progress.h"
#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/graph/changes.h"
#include "samples/fovea/view/motion.h"
#include "samples/fovea/view/picture/compare.h"
#include "samples/fovea/view/resume.h"
#include "samples/fovea/view/tev.h"
#include "samples/fovea/view/watcher.h"

namespace fovea::view {

// What runs. It changes when a page chooses something else.
struct Settings {
  session::GraphOptions graph;
  std::string scene, environment;
  glm::uvec2 size{512, 512};
  uint32_t seed = 1;
};

class Viewer {
 public:
  struct Options {
    Settings settings;
    std::string device;
    std::vector<std::string> without;  // gpu::DeviceOptions::without
    std::string tev;                   // HOST:PORT of the tev that shows a picture; "" for none
    bool validation = false;
    double frameLimit = session::kFrameLimit;  // seconds; 0 for none
    // Frames that are rendered whether somebody looks or not, after which the run freezes; 0 for no such number.
    uint64_t frames = 0;
    // Of a run that continues here; its changes of the settings are in the settings.
    std::optional<Resume> resume;
  };
  // Loads and builds everything. Throws as `fovea render` does for what it is given.
  Viewer(Exchange& exchange, const Options& options);
  ~Viewer();
  // Until the program is interrupted, or a plug-in has changed. Returns whether to go on in a new process.
  bool run();
  // Where that is to go on, but for the address of the page.
  Resume resume() const;

 private:
  // A scene with its triangles.
  struct LoadedScene {
    scene::Scene scene;
    scene::Geometry geometry;
  };
  // A graph that is ready to run, with the documents that it came from.
  struct Build {
    std::filesystem::path file;
    std::shared_ptr<LoadedScene> scene;
    graph::Description description;
    Documents documents;
    Changes changes;
    std::unique_ptr<session::GraphRun> run;
    Diagnostics messages;
  };
  // What a frame shows, and from where.
  struct Shown {
    scene::Moment moment;
    std::vector<scene::View> views;
  };

  // What of `before` can be taken over goes on in the build, with its contents if `keepContents`.
  std::unique_ptr<Build> build(const Settings& settings, std::shared_ptr<LoadedScene> scene, Build* before,
                               bool keepContents);
  void rebuildSecond(bool keepContents);
  // Throws Error, and keeps the graph that runs, if another one cannot be built.
  void rebuild(const Settings& settings, std::shared_ptr<LoadedScene> scene, bool keepContents = true);
  void reloadChanged();
  void restartFor(const std::filesystem::path& plugin);
  void watchFiles();
  void follow(const std::vector<Command>& commands);
  std::optional<Settings> changed(Settings settings, const Command& command) const;
  // Writes next to the graph, never over another file, and returns the message to show. Throws Error(CannotWrite,
  // BadInput).
  Diagnostic save(const std::string& name) const;
  bool frameIsDue();
  void render();
  void chooseObservations();
  void takeFinished();
  void drain();
  void take(graph::FrameResult result);
  void takeSecond(graph::FrameResult result);
  image::Metadata metadata(const Build& build, const Shot& shot) const;
  void publish(const Build& build, const std::string& source, const graph::FrameResult& result,
               graph::OutputData data, uint32_t frames);
  void report(std::vector<Diagnostic> messages);
  void answer(std::vector<Diagnostic> messages);
  void sendState();
  void sendTick();
  void pace();
  void throwIfObjected() const;

  Exchange& exchange_;
  Options options_;
  Settings settings_;
  Watchdog watchdog_;  // over frames
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<Build> build_;
  std::string secondName_;  // of a graph; "" for none
  std::unique_ptr<Build>
      second_;  // runs after the first in every frame, with a scene of its own on the device
  bool accumulate_ = true, broken_ = false, restart_ = false;
  std::map<std::string, FrameMean> means_;  // of sources of the second graph
  std::optional<scene::Moment> meanOf_;     // the view that the means show
  Motion motion_;
  std::vector<std::string> wanted_, observed_;  // sources; those of them that there are
  std::vector<Shown> shown_;                    // by the frames under way, oldest first
  uint64_t builds_ = risingNumber(), submitted_ = 0, messageNumber_ = 0;
  std::vector<Diagnostic> messages_;  // about the graph and its files
  std::vector<Diagnostic> answer_;    // to the last command that changed or saved the graph
  Exchange::Clock::time_point lastTick_, nextFrame_;
  double framesPerSecond_ = 0;
  Shown seen_;            // by the newest finished frame
  bool moving_ = false;   // whether it shows something else than the one before
  nlohmann::json times_;  // of the same
  std::set<std::filesystem::path> changedFiles_;
  Exchange::Clock::time_point changedAt_;
  Watcher watcher_;
  std::unique_ptr<TevStream> tev_;  // nullptr without Options::tev
};

}  // namespace fovea::view
