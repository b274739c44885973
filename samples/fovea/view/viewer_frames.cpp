// The frames of a viewed run: what is rendered when, and what pages are told about it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/scene/scene.h"
#include "framework/session/sources.h"
#include "samples/fovea/view/graph/catalog.h"
#include "samples/fovea/view/graph/describe.h"
#include "samples/fovea/view/viewer.h"

namespace fovea::view {
namespace {

using Json = nlohmann::json;
using std::chrono::milliseconds;

constexpr std::string_view kSecond = "second!";     // begins the sources of the second graph
constexpr uint64_t kMostBytes = uint64_t(4) << 20;  // of a buffer that is looked at
constexpr auto kTickEvery = milliseconds(50);

Json vectorJson(glm::vec3 v) { return {v.x, v.y, v.z}; }

// From the world to the clip space of each view, column after column.
Json viewsJson(const std::vector<scene::View>& views) {
  Json json = Json::object();
  for (const scene::View& view : views) {
    const float* first = &view.worldToClip[0][0];
    json[view.name] = std::vector<float>(first, first + 16);
  }
  return json;
}

// Whether two frames show the same but for random numbers.
bool showTheSame(const scene::Scene& scene, const scene::Moment& a, const scene::Moment& b) {
  const bool changes = !scene.movers.empty() || !scene.animations.empty() || !scene.lightMotions.empty();
  return (a.time == b.time || !changes) && a.gazes == b.gazes && a.camera.position == b.camera.position &&
         a.camera.orientation == b.camera.orientation;
}

}  // namespace

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
      graph::Observation found = session::findSource(*(ofSecond ? second_ : build_)->run->plan(),
                                                     ofSecond ? source.substr(kSecond.size()) : source);
      found.name = source;
      found.mostBytes = kMostBytes;
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
  try {
    const scene::Frame frame = build_->run->frame(moment);
    shown_.push_back({moment, frame.views});
    build_->run->submit(frame, false, observe);
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
          {"graph_hash", session::formatHash(build.run->graph().hash)},
          {"scene", build.scene->scene.name},
          {"scene_hash", session::formatHash(build.scene->scene.hash)},
          {"set", set},
          {"device", device_->name()},
          {"seed", std::to_string(settings_.seed)},
          {"size", fmt::format("{}x{}", settings_.size.x, settings_.size.y)},
          {"gaze", fmt::format("{},{}", shot.gaze.x, shot.gaze.y)},
          {"fovea_radius", fmt::format("{}", shot.foveaRadius)},
          {"exposure", fmt::format("{}", shot.exposure)}};
}

void Viewer::publish(const Build& build, const std::string& source, const graph::FrameResult& result,
                     graph::OutputData data, uint32_t frames) {
  const double own = session::parameterOr(build.run->graph(), "exposure", 0);  // 0 means the scene's
  Shot shot;
  shot.frame = result.frame;
  shot.exposure = own > 0 ? float(own) : build.scene->scene.exposure;
  shot.gaze = seen_.moment.gazes[0];
  shot.foveaRadius = build.run->frame(seen_.moment).views[0].foveaRadius;
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
    moving_ = !showTheSame(build_->scene->scene, seen_.moment, shown_.front().moment);
    seen_ = std::move(shown_.front());
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
  const bool still = meanOf_ && showTheSame(build_->scene->scene, *meanOf_, seen_.moment);
  if (!still || !accumulate_) means_.clear();
  meanOf_ = seen_.moment;
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
  const Pose pose = poseOf(seen_.moment.camera);
  Json tick{{"build", builds_},
            {"messages", messageNumber_},
            {"frame", seen_.moment.index},
            {"time", seen_.moment.time},
            {"playing", motion_.playing()},
            {"frozen", motion_.frozen()},
            {"moving", moving_},
            {"speed", motion_.speed()},
            {"recording", motion_.recording()},
            {"recorded", motion_.recorded()},
            {"camera",
             {{"position", vectorJson(pose.position)},
              {"yaw", pose.yaw},
              {"pitch", pose.pitch},
              {"own", motion_.ownCamera()},
              {"fov", seen_.moment.camera.verticalFov}}},
            {"views", viewsJson(seen_.views)},
            {"gaze", {seen_.moment.gazes[0].x, seen_.moment.gazes[0].y}},
            {"own_gaze", motion_.ownGaze()},
            {"saccade", seen_.moment.saccade},
            {"fps", framesPerSecond_},
            {"bytes", device_->allocatedBytes()},
            {"times", times_}};
  if (tev_) tick["tev"] = {{"source", tev_->source()}, {"connected", tev_->connected()}};
  if (motion_.recording())
    exchange_.setRecording(motion_.gazeTable(), motion_.cameraKeys(build_->scene->scene.origin));
  exchange_.setTick(textOf(tick));
}

void Viewer::sendState() {
  ++builds_;
  const scene::Geometry& geometry = build_->scene->geometry;
  std::vector<Diagnostic> messages = answer_;
  messages.insert(messages.end(), messages_.begin(), messages_.end());
  Json state{
      {"build", builds_},
      {"device", device_->name()},
      {"version", FOVEA_VERSION},
      {"graph", describeGraph(*build_->run->plan(), build_->description,
                              session::sceneEnvironment(device_.get(), build_->scene->scene, geometry,
                                                        settings_.size, settings_.graph.rays),
                              build_->documents, build_->changes, build_->run->executor().elementTypes())},
      {"graph_name", build_->file.stem().string()},
      {"graph_file", build_->file.string()},
      {"scene", settings_.scene},
      {"size", {settings_.size.x, settings_.size.y}},
      {"seed", settings_.seed},
      {"second", secondName_},
      {"second_graph", second_ ? describeOutputs(second_->run->graph()) : Json::array()},
      {"accumulate", accumulate_},
      {"graphs", graphNames(build_->file)},
      {"scenes", scene::names()},
      {"set", overridesOf(build_->changes)},
      {"fovea_radius", build_->run->frame(0).views[0].foveaRadius},
      {"bounds", {vectorJson(geometry.boundsMin), vectorJson(geometry.boundsMax)}},
      {"messages", describeMessages(messages)}};
  exchange_.setState(textOf(state));
  exchange_.setTick(textOf({{"build", builds_}}));
}

}  // namespace fovea::view
