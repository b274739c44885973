// Time, camera and gaze of an interactive run, which determine the next frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/session/course.h"
#include "samples/fovea/view/command.h"

namespace fovea::view {

inline constexpr double kFrameRate = 42;  // frames a second of scene time, as in `fovea render`

Pose poseOf(const scene::Camera& camera);

class Motion {
 public:
  // Follows the members that concern time, camera and gaze.
  void apply(const Command& command);
  void freeze() { frozen_ = true; }
  // Frame 0 comes next; camera and gaze stay who moves them.
  void restart();
  // The next frame. Untouched, it is frame after frame what `fovea render` shows: frame k at k / 42 seconds.
  scene::Moment next(const scene::Scene& scene);

  bool playing() const { return playing_; }
  bool frozen() const { return frozen_; }
  double speed() const { return speed_; }
  bool recording() const { return recording_; }
  bool ownCamera() const { return pose_.has_value(); }
  bool ownGaze() const { return gaze_.has_value(); }
  // The command that brings another run, which begins at frame 0, to where this one is.
  std::string asCommand() const;
  // Whether a frame is due although the run is frozen: a step, or something to see that has moved.
  bool due() const { return steps_ > 0 || moved_; }
  uint64_t nextIndex() const { return index_; }
  const scene::Moment& shown() const { return course_.shown(); }  // the last moment that next() made

  // The gaze of the frames since recording began, as `fovea render --gaze-trace FILE --gaze-gap 0` replays it.
  std::string gazeTable() const;
  // Where the camera was in these frames, as the member `camera` of a scene file.
  std::string cameraKeys(const glm::dvec3& origin) const;
  size_t recorded() const { return track_.size(); }

 private:
  double time() const { return anchor_ + double(ticks_) / kFrameRate * speed_; }
  void record(const scene::Moment& moment);
  // Where the pose has it; not set without one.
  std::optional<scene::Camera> steeredCamera(const scene::Scene& scene, double time) const;

  bool playing_ = true, frozen_ = false, recording_ = false, moved_ = false;
  double speed_ = 1, anchor_ = 0;
  uint64_t ticks_ = 0;  // steps of time since `anchor_`
  uint64_t index_ = 0;
  uint32_t steps_ = 0;
  std::optional<Pose> pose_;
  std::optional<glm::vec2> gaze_;
  session::Course course_;
  std::vector<scene::GazeSample> track_;
  std::vector<scene::CameraKey> cameraTrack_;  // of the same frames
};

}  // namespace fovea::view
