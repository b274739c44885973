#include "samples/fovea/vr/rig.h"

#include <algorithm>
#include <cmath>

namespace fovea::vr {
namespace {

constexpr float kTurn = 1.5f;   // radians a second
constexpr float kIdle = 0.15f;  // thumbsticks rest near 0, not at it

// The part of an orientation that turns about the vertical.
glm::quat heading(const glm::quat& orientation) {
  const glm::vec3 ahead = orientation * glm::vec3(0, 0, -1), up = orientation * glm::vec3(0, 1, 0);
  // Who looks straight up or down has the top of the head in front.
  const glm::vec3 level = std::abs(ahead.y) > 0.99f ? (ahead.y > 0 ? -up : up) : ahead;
  return glm::angleAxis(std::atan2(-level.x, -level.z), glm::vec3(0, 1, 0));
}

float beyondIdle(float stick) { return std::abs(stick) < kIdle ? 0 : stick; }

}  // namespace

std::vector<const char*> viewNames(bool insets) {
  if (insets) return {"left", "right", "left_inset", "right_inset"};
  return {"left", "right"};
}

Rig::Rig(const scene::Camera& camera, const Options& options) : camera_(camera), options_(options) {
  room_.position = camera.position;
  if (options.floor) room_.position.y = *options.floor;
  room_.orientation = heading(glm::normalize(camera.orientation));
}

Pose Rig::toScene(const Pose& pose) const {
  return {room_.position + room_.orientation * (options_.scale * pose.position),
          glm::normalize(room_.orientation * pose.orientation)};
}

void Rig::fly(const Tracked& tracked, double seconds) {
  if (!tracked.head) return;
  const float reach = options_.speed * options_.scale * float(seconds);
  const Pose head = toScene(*tracked.head);
  const glm::vec3 step(beyondIdle(tracked.walk.x), 0, -beyondIdle(tracked.walk.y));
  room_.position += reach * (heading(head.orientation) * step);
  room_.position.y += reach * beyondIdle(tracked.turn.y);
  // The head stays in place while the room turns around it.
  const float angle = -kTurn * float(seconds) * beyondIdle(tracked.turn.x);
  if (angle == 0) return;
  const glm::quat turn = glm::angleAxis(angle, glm::vec3(0, 1, 0));
  const glm::vec3 pivot = toScene(*tracked.head).position;
  room_.position = pivot + turn * (room_.position - pivot);
  room_.orientation = glm::normalize(turn * room_.orientation);
}

glm::vec3 Rig::lineOfSight(const Tracked& tracked, double time) {
  const glm::quat head = tracked.head->orientation;
  if (tracked.gaze) {
    sight_ = glm::inverse(head) * *tracked.gaze;
    sightTime_ = time;
  } else if (!sightTime_ || time - *sightTime_ > kGazeHold) {
    sight_ = {0, 0, -1};
  }
  return head * sight_;
}

session::Steering Rig::steer(const Tracked& tracked, double time) {
  session::Steering steering;
  steering.time = time;
  scene::Camera camera = camera_;
  const Pose head = toScene(*tracked.head);
  camera.position = head.position;
  camera.orientation = head.orientation;
  steering.camera = camera;
  const glm::vec3 sight = lineOfSight(tracked, time);
  const std::vector<const char*> names = viewNames(tracked.eyes.size() > 2);
  for (size_t i = 0; i < tracked.eyes.size(); ++i) {
    const size_t view = scene::viewIndex(names[i]);
    const Pose eye = toScene(tracked.eyes[i]);
    steering.eyes[view] = scene::Eye{eye.position, eye.orientation, tracked.frusta[i]};
    steering.gazes[view] = gazeIn(tracked.eyes[i], tracked.frusta[i], sight);
  }
  return steering;
}

glm::vec2 gazeIn(const Pose& eye, const scene::Frustum& frustum, glm::vec3 direction) {
  const glm::vec3 seen = glm::inverse(eye.orientation) * direction;
  const float depth = std::max(-seen.z, 1e-3f);  // what lies behind is beyond an edge, too
  const glm::vec2 tangent = glm::vec2(seen) / depth;
  const glm::vec2 place((tangent.x + frustum.left) / (frustum.left + frustum.right),
                        (frustum.up - tangent.y) / (frustum.up + frustum.down));
  return glm::clamp(place, 0.0f, 1.0f);
}

}  // namespace fovea::vr
