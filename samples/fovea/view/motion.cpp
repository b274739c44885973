#include "samples/fovea/view/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "framework/scene/motion/motion.h"

namespace fovea::view {

Pose poseOf(const scene::Camera& camera) {
  const glm::vec3 forward = glm::normalize(camera.orientation) * glm::vec3(0, 0, -1);
  return {camera.position, std::atan2(-forward.x, -forward.z), std::asin(std::clamp(forward.y, -1.0f, 1.0f))};
}

void Motion::apply(const Command& command) {
  if (command.sceneCamera) pose_.reset();
  if (command.pose) pose_ = command.pose;
  if (command.sceneGaze) gaze_.reset();
  if (command.gaze) gaze_ = command.gaze;
  moved_ |= command.sceneCamera || command.pose || command.sceneGaze || command.gaze;
  if (command.speed && *command.speed != speed_) {
    anchor_ = time();
    ticks_ = 0;
    speed_ = *command.speed;
  }
  if (command.time) {
    anchor_ = *command.time;
    ticks_ = 0;
    moved_ = true;
  }
  if (command.playing) playing_ = *command.playing;
  if (command.frozen) frozen_ = *command.frozen;
  if (command.step > 0) {
    frozen_ = true;
    steps_ += command.step;
  }
  if (command.restart) restart();
  if (!command.recording) return;
  recording_ = *command.recording;
  if (!recording_) return;
  // From the start, so that a replay meets the same frames.
  restart();
  track_.clear();
  cameraTrack_.clear();
  speed_ = 1;
  playing_ = true;
  frozen_ = false;
}

void Motion::restart() {
  index_ = ticks_ = 0;
  anchor_ = 0;
  course_.restart();
  moved_ = true;
}

std::optional<scene::Camera> Motion::steeredCamera(const scene::Scene& scene, double time) const {
  if (!pose_) return std::nullopt;
  scene::Camera camera = scene::cameraAt(scene, time);
  camera.position = pose_->position;
  camera.orientation =
      glm::angleAxis(pose_->yaw, glm::vec3(0, 1, 0)) * glm::angleAxis(pose_->pitch, glm::vec3(1, 0, 0));
  return camera;
}

scene::Moment Motion::next(const scene::Scene& scene) {
  if (index_ > 0 && (frozen_ ? steps_ > 0 : playing_)) ++ticks_;
  if (steps_ > 0) --steps_;
  moved_ = false;
  const double now = std::max(0.0, time());
  const scene::Moment m =
      course_.next(scene, index_, {.time = now, .camera = steeredCamera(scene, now), .gaze = gaze_});
  if (recording_) record(m);
  ++index_;
  return m;
}

std::string Motion::asCommand() const {
  nlohmann::json command{
      {"time", shown().time}, {"playing", playing_}, {"frozen", frozen_}, {"speed", speed_}};
  if (pose_)
    command["camera"] = {{"position", {pose_->position.x, pose_->position.y, pose_->position.z}},
                         {"yaw", pose_->yaw},
                         {"pitch", pose_->pitch}};
  if (gaze_) command["gaze"] = {gaze_->x, gaze_->y};
  return command.dump();
}

// A sample must not come after its frame, and the nearest float may.
void Motion::record(const scene::Moment& moment) {
  float at = float(moment.time);
  if (double(at) > moment.time) at = std::nextafter(at, -std::numeric_limits<float>::infinity());
  if (!track_.empty() && at <= track_.back().time) return;  // time stands still
  track_.push_back({at, moment.gazes[0], true, moment.gazes[1], moment.gazes[2]});
  cameraTrack_.push_back({at, moment.camera});
}

std::string Motion::cameraKeys(const glm::dvec3& origin) const {
  std::string text = "{\n  \"camera\": {\n";
  if (!cameraTrack_.empty())
    text += fmt::format("    \"fov_deg\": {:.6g},\n", glm::degrees(cameraTrack_[0].camera.verticalFov));
  if (!cameraTrack_.empty() && cameraTrack_[0].camera.aspectRatio > 0)
    text += fmt::format("    \"aspect\": {:.6g},\n", cameraTrack_[0].camera.aspectRatio);
  text += "    \"path\": [";
  const char* separator = "\n";
  for (const scene::CameraKey& key : cameraTrack_) {
    const glm::dvec3 eye = origin + glm::dvec3(key.camera.position),
                     target = eye + glm::dvec3(key.camera.orientation * glm::vec3(0, 0, -1));
    text += fmt::format(
        "{}      {{ \"t\": {:.9g}, \"eye\": [{:.12g}, {:.12g}, {:.12g}], \"target\": [{:.12g}, {:.12g}, "
        "{:.12g}] "
        "}}",
        separator, key.time, eye.x, eye.y, eye.z, target.x, target.y, target.z);
    separator = ",\n";
  }
  return text + "\n    ]\n  }\n}\n";
}

std::string Motion::gazeTable() const {
  std::string text = "# fovea render GRAPH --scene SCENE --gaze-trace THIS --gaze-gap 0\nt,x,y,valid\n";
  for (const scene::GazeSample& s : track_)
    text += fmt::format("{:.9g},{:.9g},{:.9g},1\n", s.time, s.position.x, s.position.y);
  return text;
}

}  // namespace fovea::view
