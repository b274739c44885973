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

// What a view sees, by its projection.
Frustum frustumOf(const View& view) {
  const glm::mat4& m = view.viewToClip;
  return {(1 - m[2][0]) / m[0][0], (1 + m[2][0]) / m[0][0], (m[2][1] - 1) / m[1][1],
          -(1 + m[2][1]) / m[1][1]};
}

// The part of an extent [-low, high] that is half as wide and lies around a place of it, 0 to 1.
std::pair<float, float> halfAround(float low, float high, float place) {
  const float half = 0.25f * (low + high);
  const float centre = glm::clamp(glm::mix(-low, high, place), half - low, high - half);
  return {half - centre, half + centre};
}

// The inset in what an eye sees.
Frustum insetOf(const Frustum& eye, glm::vec2 gaze) {
  const auto [left, right] = halfAround(eye.left, eye.right, gaze.x);
  const auto [up, down] = halfAround(eye.up, eye.down, gaze.y);
  return {left, right, up, down};
}

// A place in the picture of one frustum, in that of another one with the same line of sight.
glm::vec2 placeIn(const Frustum& to, const Frustum& from, glm::vec2 place) {
  const glm::vec2 tangent(glm::mix(-from.left, from.right, place.x), glm::mix(-from.up, from.down, place.y));
  return glm::clamp((tangent + glm::vec2(to.left, to.up)) / glm::vec2(to.left + to.right, to.up + to.down),
                    0.0f, 1.0f);
}

constexpr size_t kViews = std::size(kViewNames);

// From where a frame is seen, and where eyes look in it.
struct Looking {
  const Camera& camera;
  const Eyes& eyes;
  const std::array<glm::vec2, kViews>& gazes;
};

struct EyeCamera {
  Camera camera;
  std::optional<Frustum> frustum{};  // not set: that of the camera
};

EyeCamera cameraOf(const Camera& camera, const Eye& eye) {
  EyeCamera of{camera, eye.frustum};
  of.camera.position = eye.position, of.camera.orientation = eye.orientation;
  return of;
}

// An eye as it follows from the camera, or as it is given.
EyeCamera eyeAt(const Scene& scene, size_t index, const Looking& looking) {
  constexpr float kSides[] = {0, -1, 1};
  if (const std::optional<Eye>& eye = looking.eyes[index]) return cameraOf(looking.camera, *eye);
  EyeCamera of{eyeOf(looking.camera, kSides[index], scene.ipd)};
  if (scene.lens && kSides[index] != 0) of.frustum = frustumOf(*scene.lens, kSides[index] < 0);
  return of;
}

// The same as a view, or an inset. One that is not given is part of what its eye sees.
View viewAt(const Scene& scene, const Geometry& geometry, glm::uvec2 size, size_t index,
            const Looking& looking, const std::optional<glm::uvec2>& inset) {
  const glm::vec2 gaze = looking.gazes[index];
  const auto* const found = std::find(std::begin(kInsets), std::end(kInsets), index);
  if (found == std::end(kInsets)) {
    const EyeCamera eye = eyeAt(scene, index, looking);
    return makeView(eye.camera, size, geometry, gaze, eye.frustum);
  }
  const glm::uvec2 small = inset.value_or(size);
  if (const std::optional<Eye>& given = looking.eyes[index]) {
    const EyeCamera eye = cameraOf(looking.camera, *given);
    return makeView(eye.camera, small, geometry, gaze, eye.frustum);
  }
  const EyeCamera eye = eyeAt(scene, kInsetEyes[found - std::begin(kInsets)], looking);
  const Frustum outer = frustumOf(makeView(eye.camera, size, geometry, gaze, eye.frustum));
  const Frustum inner = insetOf(outer, gaze);
  return makeView(eye.camera, small, geometry, placeIn(inner, outer, gaze), inner);
}

// Frame::saccade of frame `index` of a sequence, for whichever eye jumped last.
float saccadeAt(const Scene& scene, uint64_t index, double framesPerSecond) {
  for (uint64_t age = 0; age < std::min<uint64_t>(kSaccadeFrames, index); ++age) {
    const auto now = gazesAt(scene, double(index - age) / framesPerSecond),
               before = gazesAt(scene, double(index - age - 1) / framesPerSecond);
    for (size_t i = 0; i < kInsets[0]; ++i)
      if (glm::distance(now[i], before[i]) > kGazeJump) return 1 - float(age) / float(kSaccadeFrames);
  }
  return 0;
}

}  // namespace

std::array<glm::vec2, std::size(kViewNames)> gazesAt(const Scene& scene, double time) {
  const GazeSample gaze = gazeAt(scene.gaze, time, scene.gazeGap);
  const glm::vec2 left = gaze.left.value_or(gaze.position), right = gaze.right.value_or(gaze.position);
  return {gaze.position, left, right, left, right};
}

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

std::vector<std::pair<std::string, VkExtent2D>> frameViews(VkExtent2D size, VkExtent2D inset) {
  std::vector<std::pair<std::string, VkExtent2D>> views;
  for (const char* name : kViewNames) views.emplace_back(name, size);
  for (const size_t view : kInsets) views[view].second = inset;
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
  m.previousGazes = gazesAt(scene, m.before);
  m.saccade = saccadeAt(scene, index, framesPerSecond);
  m.cameraCut = index == 0;
  return m;
}

Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond) {
  return makeFrame(scene, geometry, size, momentAt(scene, index, framesPerSecond), seed);
}

Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, const Moment& moment,
                uint32_t seed, const std::optional<glm::uvec2>& inset) {
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
  for (size_t i = 0; i < kViews; ++i) {
    View view = viewAt(scene, geometry, size, i, {moment.camera, moment.eyes, moment.gazes}, inset);
    view.name = kViewNames[i];
    if (!moment.cameraCut) {
      const Looking before{moment.previousCamera, moment.previousEyes, moment.previousGazes};
      view.previousWorldToClip = viewAt(scene, geometry, size, i, before, inset).worldToClip;
    }
    f.views.push_back(std::move(view));
  }
  ObjectPoses poses = objectsAt(scene, geometry, f.time, moment.before);
  f.objects = std::move(poses.objects);
  f.joints = std::move(poses.joints), f.previousJoints = std::move(poses.previousJoints);
  f.weights = std::move(poses.weights), f.previousWeights = std::move(poses.previousWeights);
  return f;
}

}  // namespace fovea::scene
