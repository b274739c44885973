// The moments of a run that somebody steers: each is relative to the one that was shown before it.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <optional>

#include "framework/scene/frame.h"

namespace fovea::session {

struct Steering {
  double time = 0;                      // of the scene, in seconds
  std::optional<scene::Camera> camera;  // not set: the scene's
  scene::Eyes eyes{};                   // those that are not set follow from the camera
  std::optional<glm::vec2> gaze;        // of all views; not set: the scene's
  std::array<std::optional<glm::vec2>, std::size(scene::kViewNames)> gazes{};  // of single views, instead
  bool cut = false;                                                            // Frame::cameraCut
};

class Course {
 public:
  // What frame `index` shows. The first one, and any that is cut, stands still. Untouched, frame k at k / rate seconds
  // is that of scene::momentAt().
  scene::Moment next(const scene::Scene& scene, uint64_t index, const Steering& steering);
  // Goes on after a moment that comes from elsewhere.
  void follow(const scene::Moment& moment);
  void restart() { begun_ = false; }
  bool begun() const { return begun_; }
  const scene::Moment& shown() const { return shown_; }  // the last one

 private:
  bool begun_ = false;
  uint32_t sinceJump_ = scene::kSaccadeFrames;
  scene::Moment shown_;
};

}  // namespace fovea::session
