#include "framework/scene/frame.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace fovea::scene {
namespace {

// Far enough to hold the whole scene from where the camera stands; nothing is clipped behind it.
float farPlane(const Camera& camera, const Geometry& geometry) {
  if (camera.zFar > camera.zNear) return camera.zFar;
  float reach = 100.0f;
  if (!geometry.empty())
    reach = glm::length(glm::max(glm::abs(geometry.boundsMin - camera.position),
                                 glm::abs(geometry.boundsMax - camera.position)));
  return std::max(1.01f * reach, 10.0f * camera.zNear);
}

// Catmull-Rom through the four keys around u in [0, 1] between p1 and p2, with the keys' own times (finite
// differences).
template <class V>
V hermite(const V& p0, const V& p1, const V& p2, const V& p3, float t0, float t1, float t2, float t3,
          float u) {
  const float span = t2 - t1;
  const V m1 = (p2 - p0) * (span / (t2 - t0));
  const V m2 = (p3 - p1) * (span / (t3 - t1));
  const float u2 = u * u, u3 = u2 * u;
  return p1 * (2 * u3 - 3 * u2 + 1) + m1 * (u3 - 2 * u2 + u) + p2 * (3 * u2 - 2 * u3) + m2 * (u3 - u2);
}

glm::quat sameSide(const glm::quat& q, const glm::quat& reference) {
  return glm::dot(q, reference) < 0 ? -q : q;
}

Camera cameraOnPath(const std::vector<CameraKey>& path, float time) {
  if (time <= path.front().time) return path.front().camera;
  if (time >= path.back().time) return path.back().camera;
  const auto after = std::upper_bound(path.begin(), path.end(), time,
                                      [](float t, const CameraKey& k) { return t < k.time; });
  const size_t i2 = size_t(after - path.begin()), i1 = i2 - 1;
  const size_t i0 = i1 > 0 ? i1 - 1 : i1, i3 = i2 + 1 < path.size() ? i2 + 1 : i2;
  const CameraKey &k0 = path[i0], &k1 = path[i1], &k2 = path[i2], &k3 = path[i3];
  const float u = (time - k1.time) / (k2.time - k1.time);
  Camera c = k1.camera;
  c.position = hermite(k0.camera.position, k1.camera.position, k2.camera.position, k3.camera.position,
                       k0.time, k1.time, k2.time, k3.time, u);
  // The same spline on the sphere of rotations (then normalised): no jump of the turning speed at a key.
  const glm::quat q1 = k1.camera.orientation, q2 = sameSide(k2.camera.orientation, q1);
  c.orientation =
      glm::normalize(hermite(sameSide(k0.camera.orientation, q1), q1, q2, sameSide(k3.camera.orientation, q2),
                             k0.time, k1.time, k2.time, k3.time, u));
  c.verticalFov = glm::mix(k1.camera.verticalFov, k2.camera.verticalFov, u);
  return c;
}

// The sample in force at `time`: the last one at or before it that is valid; linear between two valid
// neighbours would smear a saccade over the sampling interval, so samples hold.
glm::vec2 gazeAt(const std::vector<GazeSample>& gaze, double time) {
  glm::vec2 position(0.5f);
  bool found = false;
  for (const GazeSample& g : gaze) {
    if (!g.valid) continue;
    if (found && double(g.time) > time) break;
    position = g.position;
    found = true;
    if (double(g.time) > time) break;  // before the first valid sample: that one
  }
  return position;
}

Camera cameraAt(const Scene& scene, double time) {
  if (!scene.cameraPath.empty()) return cameraOnPath(scene.cameraPath, float(time));
  return scene.cameras.empty() ? Camera{} : scene.cameras.front();
}

}  // namespace

glm::vec3 View::rayDirection(glm::vec2 p) const {
  const float tanY = std::tan(0.5f * verticalFov);
  const float tanX = tanY * float(size.x) / float(size.y);
  const glm::vec2 ndc = 2.0f * p / glm::vec2(size) - 1.0f;  // y down
  const glm::vec3 inView(ndc.x * tanX, -ndc.y * tanY, -1.0f);
  return glm::transpose(glm::mat3(worldToView)) * inView;
}

View makeView(const Camera& camera, glm::uvec2 size, const Geometry& geometry, glm::vec2 gaze) {
  View v;
  v.size = glm::max(size, glm::uvec2(1));
  v.eye = camera.position;
  v.gaze = gaze;
  v.verticalFov = camera.verticalFov;
  const glm::quat q = glm::normalize(camera.orientation);
  const glm::mat3 rotation = glm::transpose(glm::mat3_cast(q));
  v.worldToView = glm::mat4(rotation);
  v.worldToView[3] = glm::vec4(-(rotation * camera.position), 1.0f);
  v.viewToClip = glm::perspectiveRH_ZO(camera.verticalFov, float(v.size.x) / float(v.size.y), camera.zNear,
                                       farPlane(camera, geometry));
  v.viewToClip[1][1] *= -1.0f;  // Vulkan's y points down
  v.worldToClip = v.viewToClip * v.worldToView;
  v.clipToWorld = glm::mat4(glm::inverse(glm::dmat4(v.worldToClip)));
  v.previousWorldToClip = v.worldToClip;
  return v;
}

const View* Frame::findView(std::string_view name) const {
  for (const View& v : views)
    if (v.name == name) return &v;
  return nullptr;
}

Frame makeFrame(const Scene& scene, const Geometry& geometry, glm::uvec2 size, uint64_t index, uint32_t seed,
                double framesPerSecond) {
  Frame f;
  f.index = index;
  f.time = double(index) / framesPerSecond;
  f.seed = seed;
  f.exposure = scene.exposure;
  f.cameraCut = index == 0;
  f.lights = scene.lights;
  f.scene = &scene;
  f.geometry = &geometry;
  View view = makeView(cameraAt(scene, f.time), size, geometry, gazeAt(scene.gaze, f.time));
  if (index > 0) {
    const double before = double(index - 1) / framesPerSecond;
    view.previousWorldToClip = makeView(cameraAt(scene, before), size, geometry).worldToClip;
  }
  f.views.push_back(view);
  return f;
}

}  // namespace fovea::scene
