// Tests where the room of a headset lies in the scene, and where its gaze meets the pictures of the eyes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/scene/frame.h"
#include "samples/fovea/vr/rig.h"

namespace fovea::vr {
namespace {

const glm::vec3 kUp(0, 1, 0);

scene::Camera cameraAt(glm::vec3 position, float yaw, float pitch = 0) {
  scene::Camera camera;
  camera.position = position;
  camera.orientation = glm::angleAxis(yaw, kUp) * glm::angleAxis(pitch, glm::vec3(1, 0, 0));
  camera.zNear = 0.03f;
  return camera;
}

// A head at the origin of the room, which looks ahead through two parallel eyes.
Tracked lookingAhead(glm::vec3 head = glm::vec3(0)) {
  Tracked tracked;
  tracked.head = Pose{head};
  for (const float side : {-0.03f, 0.03f}) {
    tracked.eyes.push_back({head + glm::vec3(side, 0, 0)});
    tracked.frusta.push_back({1, 1, 1, 1});
  }
  return tracked;
}

void expectNear(glm::vec3 a, glm::vec3 b) {
  EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

const scene::Eye& eyeOf(const session::Steering& steering, const char* view) {
  return *steering.eyes[scene::viewIndex(view)];
}
glm::vec2 gazeOf(const session::Steering& steering, const char* view) {
  return *steering.gazes[scene::viewIndex(view)];
}

TEST(VrRig, BeginsAtTheCameraAndLevel) {
  Rig rig(cameraAt({1, 2, 3}, glm::half_pi<float>(), -0.4f), {});  // looks along -X, and down
  const session::Steering steering = rig.steer(lookingAhead(), 0);
  expectNear(steering.camera->position, {1, 2, 3});
  expectNear(steering.camera->orientation * glm::vec3(0, 0, -1), {-1, 0, 0});
  expectNear(steering.camera->orientation * kUp, kUp);
  EXPECT_EQ(steering.camera->zNear, 0.03f);
  expectNear(eyeOf(steering, "left").position, {1, 2, 3.03f});
  expectNear(eyeOf(steering, "right").position, {1, 2, 2.97f});
}

TEST(VrRig, ScalesTheRoomAndPutsItsFloorWhereAsked) {
  Rig rig(cameraAt({1, 2, 3}, 0), {.scale = 10, .floor = -4.0f});
  const session::Steering steering = rig.steer(lookingAhead({0, 1.7f, -0.5f}), 0);
  expectNear(steering.camera->position, {1, 13, -2});
  expectNear(eyeOf(steering, "right").position - eyeOf(steering, "left").position, {0.6f, 0, 0});
}

TEST(VrRig, FliesWhereTheHeadLooksAndTurnsAroundIt) {
  Rig rig(cameraAt({0, 0, 0}, 0), {.scale = 2, .speed = 3});
  Tracked tracked = lookingAhead({0.5f, 0, 0});
  tracked.head->orientation = glm::angleAxis(glm::half_pi<float>(), kUp) *
                              glm::angleAxis(0.5f, glm::vec3(1, 0, 0));  // along -X, and up
  tracked.walk = {0, 1};
  rig.fly(tracked, 0.5);
  expectNear(rig.toScene(*tracked.head).position, {1 - 3, 0, 0});
  tracked.walk = {0.1f, -0.1f};  // at rest
  rig.fly(tracked, 0.5);
  expectNear(rig.toScene(*tracked.head).position, {-2, 0, 0});
  tracked.walk = {0, 0};
  tracked.turn = {-1, 0};
  rig.fly(tracked, 1);
  const Pose turned = rig.toScene(*tracked.head);
  expectNear(turned.position, {-2, 0, 0});
  const float angle = glm::half_pi<float>() + 1.5f;
  expectNear(turned.orientation * glm::vec3(1, 0, 0), {std::cos(angle), 0, -std::sin(angle)});
  tracked.turn = {0, 1};
  rig.fly(tracked, 0.5);
  EXPECT_NEAR(rig.toScene(*tracked.head).position.y, 3, 1e-5);
}

TEST(VrRig, AHeadThatIsNotTrackedDoesNotFly) {
  Rig rig(cameraAt({0, 0, 0}, 0), {});
  Tracked tracked;
  tracked.walk = {0, 1};
  rig.fly(tracked, 1);
  expectNear(rig.toScene({}).position, {0, 0, 0});
}

TEST(VrRig, GazeMeetsThePictureWhereItsProjectionHasIt) {
  // What an eye shows at a place of its picture lies in the direction that the view has for it.
  const scene::Frustum frustum{1.3f, 0.8f, 0.9f, 1.1f};
  const glm::quat canted = glm::angleAxis(0.2f, kUp);
  const Pose eye{{0.1f, 1, -2}, canted};
  scene::Geometry geometry;
  scene::Camera camera;
  camera.position = eye.position;
  camera.orientation = eye.orientation;
  const scene::View view = scene::makeView(camera, {200, 100}, geometry, glm::vec2(0.5f), frustum);
  for (const glm::vec2 place : {glm::vec2(0.5f), glm::vec2(0.1f, 0.9f), glm::vec2(0.75f, 0.3f)}) {
    const glm::vec3 direction = glm::normalize(view.rayDirection(place * glm::vec2(view.size)));
    EXPECT_LT(glm::distance(gazeIn(eye, frustum, direction), place), 1e-5f) << place.x;
  }
  EXPECT_EQ(gazeIn(eye, frustum, canted * glm::vec3(9, 0, -1)).x, 1);
  EXPECT_EQ(gazeIn(eye, frustum, canted * glm::vec3(-1, 0, 0.1f)).x, 0);  // behind the picture
}

TEST(VrRig, ALostGazeStaysAndThenReturnsToTheMiddle) {
  Rig rig(cameraAt({0, 0, 0}, 0), {});
  Tracked tracked = lookingAhead();
  EXPECT_EQ(gazeOf(rig.steer(tracked, 0), "left"), glm::vec2(0.5f));  // never seen
  tracked.gaze = glm::normalize(glm::vec3(0.5f, 0, -1));
  EXPECT_NEAR(gazeOf(rig.steer(tracked, 1), "left").x, 0.75f, 1e-6);
  tracked.gaze.reset();
  // It turns with the head.
  const glm::quat turn = glm::angleAxis(0.7f, kUp);
  tracked.head->orientation = turn;
  for (Pose& eye : tracked.eyes) eye.orientation = turn;
  EXPECT_NEAR(gazeOf(rig.steer(tracked, 1 + kGazeHold), "right").x, 0.75f, 1e-5);
  EXPECT_NEAR(gazeOf(rig.steer(tracked, 1.01 + kGazeHold), "right").x, 0.5f, 1e-5);
}

TEST(VrRig, InsetsHaveEyesAndGazesOfTheirOwn) {
  Rig rig(cameraAt({0, 0, 0}, 0), {});
  Tracked tracked = lookingAhead();
  for (int i = 0; i < 2; ++i) {
    tracked.eyes.push_back(tracked.eyes[i]);
    tracked.frusta.push_back({0.5f, 0.5f, 0.5f, 0.5f});
  }
  tracked.gaze = glm::normalize(glm::vec3(0.25f, 0, -1));
  const session::Steering steering = rig.steer(tracked, 0);
  EXPECT_NEAR(gazeOf(steering, "left").x, 0.625f, 1e-6);
  EXPECT_NEAR(gazeOf(steering, "left_inset").x, 0.75f, 1e-6);
  EXPECT_EQ(eyeOf(steering, "right_inset").frustum.up, 0.5f);
}

}  // namespace
}  // namespace fovea::vr
