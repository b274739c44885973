// Shows a graph in a headset: from the scene and the graph to the last frame of the session.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/watchdog.h"
#include "framework/session/graph_run.h"
#include "framework/session/inputs.h"
#include "framework/session/progress.h"
#include "framework/session/timings.h"
#include "samples/fovea/vr/frame_log.h"
#include "samples/fovea/vr/rig.h"
#include "samples/fovea/vr/runtime.h"
#include "samples/fovea/vr/session.h"
#include "samples/fovea/vr/tracking.h"

namespace fovea::vr {

struct Options {
  session::GraphOptions graph;
  std::string scene, environment;
  std::optional<glm::uvec2> size;  // pixels an eye; not set: what the headset recommends
  double resolution = 1;           // factor on each side of that
  Rig::Options rig;
  double speed = 1;  // of the scene's time
  uint32_t seed = 1;
  uint64_t frames = 0;               // to show, after which the session is asked to end; 0 for no such number
  std::vector<std::string> without;  // gpu::DeviceOptions::without
  std::string record, log, timings;  // files to write; "" for none
  bool validation = false;
  double frameLimit = session::kFrameLimit;  // seconds; 0 for none
};

class Application {
 public:
  // Loads and builds everything. Throws as `fovea render` does for what it is given, and as Runtime does.
  explicit Application(const Options& options);
  ~Application();
  // Until the session ends. Throws Error(DeviceLost) if the headset is lost.
  void run();
  // Prints what was counted, and writes the files that were asked for.
  void report();

 private:
  void loadInputs();
  void chooseViews();
  void build();
  void frame();
  void render(const FrameTime& time, const Tracked& tracked);
  void takeFinished(bool all);
  double secondsOf(XrTime display);

  const Options& options_;
  session::Progress progress_;
  Watchdog watchdog_;  // over frames
  Diagnostics messages_;
  graph::Description description_;
  scene::Scene scene_;
  scene::Geometry geometry_;
  bool insets_ = false;
  std::vector<std::string> outputs_;  // of the views, in the order of viewNames()
  XrViewConfigurationType configuration_ = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  glm::uvec2 size_{0}, insetSize_{0};

  std::unique_ptr<Runtime> runtime_;
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<session::GraphRun> run_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<Tracking> tracking_;
  std::vector<Swapchain> swapchains_;
  std::vector<graph::OutputCopy> copies_;
  std::optional<Rig> rig_;
  session::Course course_;
  std::unique_ptr<session::Timings> timings_;  // empty unless they are asked for: sessions may last for hours
  FrameLog log_;
  std::vector<scene::Moment> recorded_;
  std::optional<XrTime> first_, last_;  // display times of frames
  uint64_t index_ = 0;
};

}  // namespace fovea::vr
