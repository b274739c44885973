#include "framework/scene/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <utility>

#include "framework/scene/lights.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace {

// Distance that encloses the whole scene as seen from the camera, so that nothing is clipped behind it.
float farPlane(const Camera& camera, const Geometry& geometry) {
  if (camera.zFar > camera.zNear) return camera.zFar;
  float reach = 100.0f;
  if (!geometry.empty())
    reach = glm::length(glm::max(glm::abs(geometry.boundsMin - camera.position),
                                 glm::abs(geometry.boundsMax - camera.position)));
  return std::max(1.01f * reach, 10.0f * camera.zNear);
}

// The vertical field of view with which both sides of the author's picture are seen in one of this shape.
float fovIn(const Camera& camera, float shape) {
  if (camera.aspectRatio <= shape) return camera.verticalFov;
  return 2 * std::atan(std::tan(0.5f * camera.verticalFov) * camera.aspectRatio / shape);
}

// One eye of a camera. `side` is -1 for left, 1 for right and 0 for the camera itself.
Camera eyeOf(Camera camera, float side, float ipd) {
  camera.position += 0.5f * side * ipd * (glm::normalize(camera.orientation) * glm::vec3(1, 0, 0));
  return camera;
}

// The radical inverse of Halton's sequence: the digits of a number, mirrored at the point.
float mirrored(uint32_t number, uint32_t base) {
  float value = 0, digit = 1;
  for (; number > 0; number /= base) value += (digit /= float(base)) * float(number % base);
  return value;
}
glm::vec2 halton(uint32_t number) { return {mirrored(number, 2), mirrored(number, 3)}; }

// Moves the picture of a projection by `offset` in clip space.
glm::mat4 shifted(const glm::mat4& projection, glm::vec2 offset) {
  glm::mat4 m = projection;
  for (int c = 0; c < 4; ++c) m[c] += glm::vec4(offset * projection[c].w, 0, 0);
  return m;
}

constexpr size_t kViews = std::size(kViewNames);

// Where each view's eye looks.
std::array<glm::vec2, kViews> gazesAt(const Scene& scene, double time) {
  const GazeSample gaze = gazeAt(scene.gaze, time, scene.gazeGap);
  return {gaze.position, gaze.left.value_or(gaze.position), gaze.right.value_or(gaze.position)};
}

// Frame::saccade of frame `index` of a sequence, for whichever eye jumped last.
float saccadeAt(const Scene& scene, uint64_t index, double framesPerSecond) {
  for (uint64_t age = 0; age < std::min<uint64_t>(kSaccadeFrames, index); ++age) {
    const auto now = gazesAt(scene, double(index - age) / framesPerSecond),
               before = gazesAt(scene, double(index - age - 1) / framesPerSecond);
    for (size_t i = 0; i < kViews; ++i)
      if (glm::distance(now[i], before[i]) > kGazeJump) return 1 - float(age) / float(kSaccadeFrames);
  }
  return 0;
}

}  // namespace

glm::vec3 View::rayDirection(glm::vec2 p) const {
  const glm::vec2 ndc = 2.0f * p / glm::vec2(size) - 1.0f;  // y down
  const glm::vec3 inView((ndc.x + viewToClip[2][0]) / viewToClip[0][0],
                         (ndc.y + viewToClip[2][1]) / viewToClip[1][1], -1.0f);
  return glm::transpose(glm::mat3(worldToView)) * inView;
}

Frustum frustumOf(const Lens& lens, bool left) {
  const float outward = std::tan(lens.outward), inward = std::tan(lens.inward);
  return {left ? outward : inward, left ? inward : outward, std::tan(lens.up), std::tan(lens.down)};
}

View makeView(const Camera& camera, glm::uvec2 size, const Geometry& geometry, glm::vec2 gaze,
              const std::optional<Frustum>& frustum) {
  View v;
  v.size = glm::max(size, glm::uvec2(1));
  v.eye = camera.position;
  v.gaze = gaze;
  const float shape = float(v.size.x) / float(v.size.y);
  v.verticalFov = fovIn(camera, shape);
  const glm::quat q = glm::normalize(camera.orientation);
  const glm::mat3 rotation = glm::transpose(glm::mat3_cast(q));
  v.worldToView = glm::mat4(rotation);
  v.worldToView[3] = glm::vec4(-(rotation * camera.position), 1.0f);
  const float zNear = camera.zNear, zFar = farPlane(camera, geometry);
  if (frustum) {
    const Frustum& f = *frustum;
    v.viewToClip =
        glm::frustumRH_ZO(-f.left * zNear, f.right * zNear, -f.down * zNear, f.up * zNear, zNear, zFar);
    v.viewToClip[2][1] *= -1.0f;  // with [1][1] below
    v.verticalFov = std::atan(f.up) + std::atan(f.down);
  } else {
    v.viewToClip = glm::perspectiveRH_ZO(v.verticalFov, shape, zNear, zFar);
  }
  v.viewToClip[1][1] *= -1.0f;  // Vulkan's y points down
  v.worldToClip = v.viewToClip * v.worldToView;
  v.clipToWorld = glm::mat4(glm::inverse(glm::dmat4(v.worldToClip)));
  v.previousWorldToClip = v.worldToClip;
  return v;
}

void jitter(View& view, glm::vec2 now, glm::vec2 before) {
  view.jitter = now;
  view.previousJitter = before;
  const glm::vec2 pixel = 2.0f / glm::vec2(view.size);
  if (before != glm::vec2(0)) view.previousWorldToClip = shifted(view.previousWorldToClip, -pixel * before);
  if (now == glm::vec2(0)) return;
  view.viewToClip = shifted(view.viewToClip, -pixel * now);
  view.worldToClip = shifted(view.worldToClip, -pixel * now);
  view.clipToWorld = glm::mat4(glm::inverse(glm::dmat4(view.worldToClip)));
}

glm::vec2 jitterAt(uint64_t index, uint32_t count) {
  if (count < 2) return glm::vec2(0);
  glm::vec2 mean(0);
  for (uint32_t i = 1; i <= count; ++i) mean += halton(i) / float(count);
  return halton(uint32_t(index % count) + 1) - mean;
}

const View* Frame::findView(std::string_view name) const {
  for (const View& v : views)
    if (v.name == name) return &v;
  return nullptr;
}

size_t viewIndex(std::string_view name) {
  const auto found = std::ranges::find(kViewNames, name);
  if (found == std::end(kViewNames))
    throw Error(ExitCode::Internal, "there is no view `" + std::string(name) + "`");
  return size_t(found - std::begin(kViewNames));
}

std::vector<std::pair<std::string, VkExtent2D>> frameViews(VkExtent2D size) {
  std::vector<std::pair<std::string, VkExtent2D>> views;
  for (const char* name : kViewNames) views.emplace_back(name, size);
  return views;
}

Moment momentAt(const Scene& scene, uint64_t index, double framesPerSecond) {
  Moment m;
  m.index = index;
  m.time = double(index) / framesPerSecond;
  m.before = index > 0 ? double(index - 1) / framesPerSecond : m.time;
  m.camera = cameraAt(scene, m.time);
  m.previousCamera = cameraAt(scene, m.before);
  m.gazes = gazesAt(scene, m.time);
  m.saccade = saccadeAt(scene, index, framesPerSecond);
  m.cameraCut = index == 0;
  return m;
}

Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond) {
  return makeFrame(scene, geometry, size, momentAt(scene, index, framesPerSecond), seed);
}

Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, const Moment& moment,
                uint32_t seed) {
  Frame f;
  f.index = moment.index;
  f.time = moment.time;
  f.seed = seed;
  f.exposure = scene.exposure;
  f.preExposure = preExposure(scene);
  f.cameraCut = moment.cameraCut;
  f.saccade = moment.saccade;
  f.lights = lightsAt(scene, f.time);
  f.scene = &scene;
  f.geometry = &geometry;
  const Camera &camera = moment.camera, &previousCamera = moment.previousCamera;
  const auto& gazes = moment.gazes;
  const float sides[] = {0, -1, 1};
  for (size_t i = 0; i < kViews; ++i) {
    const auto viewOf = [&](Camera of, const std::optional<Eye>& eye) {
      std::optional<Frustum> frustum;
      if (eye) {
        of.position = eye->position, of.orientation = eye->orientation;
        frustum = eye->frustum;
      } else {
        of = eyeOf(of, sides[i], scene.ipd);
        if (scene.lens && sides[i] != 0) frustum = frustumOf(*scene.lens, sides[i] < 0);
      }
      return makeView(of, size, geometry, gazes[i], frustum);
    };
    View view = viewOf(camera, moment.eyes[i]);
    view.name = kViewNames[i];
    if (!moment.cameraCut)
      view.previousWorldToClip = viewOf(previousCamera, moment.previousEyes[i]).worldToClip;
    f.views.push_back(std::move(view));
  }
  ObjectPoses poses = objectsAt(scene, geometry, f.time, moment.before);
  f.objects = std::move(poses.objects);
  f.joints = std::move(poses.joints), f.previousJoints = std::move(poses.previousJoints);
  f.weights = std::move(poses.weights), f.previousWeights = std::move(poses.previousWeights);
  return f;
}

}  // namespace fovea::scene
