// Where the room of the headset lies in the scene: what is tracked in the one becomes eyes and gazes in the other.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

#include "framework/session/course.h"

namespace fovea::vr {

struct Pose {
  glm::vec3 position{0};  // metres
  glm::quat orientation{1, 0, 0, 0};
};

// What a headset tells of a moment, in its own space: Y is up.
struct Tracked {
  std::optional<Pose> head;  // not set while it is not tracked
  std::vector<Pose> eyes;    // of the views, in the order of viewNames()
  std::vector<scene::Frustum> frusta;
  std::optional<glm::vec3>
      gaze;  // unit direction of the line of sight; not set in a blink, or while it is not tracked
  int64_t gazeTime = 0;        // at which the eye tracker has seen it, nanoseconds
  glm::vec2 walk{0}, turn{0};  // thumbsticks, -1 to 1: x to the right, y forwards or up
};

// Views of graphs that the views of a headset show, in the order of OpenXR.
std::vector<const char*> viewNames(bool insets);

// A lost gaze stays so long where it was in the picture, then it returns to straight ahead. Seconds.
inline constexpr double kGazeHold = 0.5;

class Rig {
 public:
  struct Options {
    float scale = 1;  // metres of the scene in a metre of the room
    std::optional<float>
        floor;  // height in the scene of the room's floor; not set: eyes begin at the camera's height
    float speed = 1.5f;  // of flying, metres of the room a second
  };
  // The origin of the room comes to this camera, and forwards is where it looks, but level.
  Rig(const scene::Camera& camera, const Options& options);

  // Flies on by the thumbsticks.
  void fly(const Tracked& tracked, double seconds);
  // What the next frame shows at `time` of the scene, in seconds. The head must be tracked.
  session::Steering steer(const Tracked& tracked, double time);
  Pose toScene(const Pose& pose) const;

 private:
  glm::vec3 lineOfSight(const Tracked& tracked, double time);

  scene::Camera camera_;
  Options options_;
  Pose room_;  // of the origin of the room, in the scene
  // The last line of sight that was tracked, relative to the head, and when.
  glm::vec3 sight_{0, 0, -1};
  std::optional<double> sightTime_;
};

// Where a line of sight meets the picture of an eye, in normalised image coordinates, or the nearest place within it.
glm::vec2 gazeIn(const Pose& eye, const scene::Frustum& frustum, glm::vec3 direction);

}  // namespace fovea::vr
